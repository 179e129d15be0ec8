// The page and its data on http://127.0.0.1:PORT/TOKEN/.
//
// Only who knows the token, 128 random bits in the address, is answered; only on this machine; only
// as 127.0.0.1 or localhost, so that no other site's name can be pointed here.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "tools/visualizer/page_scene.h"

#include "lf/core/result.h"

namespace lf {

class PageServer {
 public:
  //   port  0: any that is free
  // kOutput: the port is taken, this build has no page.
  static Result<std::unique_ptr<PageServer>> Open(PageScene& scene, int port);
  ~PageServer();

  // http://127.0.0.1:8080/0123456789abcdef0123456789abcdef/
  const std::string& address() const { return address_; }
  // Until the flag is set. kOutput: it cannot listen.
  Result<void> ServeUntil(const std::atomic<bool>& interrupted);

 private:
  struct Parts;
  explicit PageServer(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
  std::string address_;
};

}  // namespace lf
