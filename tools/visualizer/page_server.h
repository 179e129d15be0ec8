// SPDX-License-Identifier: Apache-2.0
// Serves the page and its data at http://127.0.0.1:PORT/TOKEN/.
//
// Requests are answered only with the token, 128 random bits in the address; only on this machine;
// and only for loopback names and the hosts of allowed reverse proxies, so that the DNS name of
// another site cannot be used to read the page (page_request.h).
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tools/visualizer/page_scene.h"
#include "tools/visualizer/web_origin.h"

#include "lf/core/result.h"

namespace lf {

class PageServer {
 public:
  // Opens the port on this machine. kOutput: the port cannot be opened, or the program was built
  // without the page.
  //   port             0: any free port
  //   allowed_origins  of reverse proxies through which the page may be opened
  static Result<std::unique_ptr<PageServer>> Open(PageScene& scene, int port,
                                                  std::vector<WebOrigin> allowed_origins = {});
  ~PageServer();

  // Returns the address of the page, such as
  // http://127.0.0.1:8080/0123456789abcdef0123456789abcdef/.
  const std::string& address() const { return address_; }
  const std::string& token() const { return token_; }
  // Serves the page until the flag is set. kOutput: the machine has no thread or memory left.
  Result<void> ServeUntil(const std::atomic<bool>& interrupted);

 private:
  struct Parts;
  explicit PageServer(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
  std::string address_;
  std::string token_;
};

}  // namespace lf
