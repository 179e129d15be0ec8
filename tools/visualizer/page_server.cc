// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/page_server.h"

#include <fmt/format.h>
#include <sys/random.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <system_error>
#include <thread>
#include <utility>

#include "tools/visualizer/live_view.h"
#include "tools/visualizer/page_answers.h"
#include "tools/visualizer/page_daemon.h"
#include "tools/visualizer/page_edits.h"
#include "tools/visualizer/page_files.h"
#include "tools/visualizer/page_port.h"
#include "tools/visualizer/preview_render.h"
#include "tools/visualizer/render_folder.h"

namespace lf {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kBetweenLooks(400);

Result<std::string> MakeToken() {
  std::array<unsigned char, 16> bytes;
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    return OutputError(
        "the page cannot be served, because the system provides no random numbers for the secret "
        "in its address");
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

}  // namespace

struct PageServer::Parts {
  Parts(PageScene& page_scene, PageDoor door, int listening)
      : scene(page_scene),
        socket(listening),
        preview(page_scene),
        live(page_scene, page_scene.arguments().live_memory_bytes),
        daemon(std::move(door), page_scene.events(),
               [this](const RequestHead& head, std::string_view name, std::string&& body) {
                 return head.method == "POST" ? Edit(scene, preview, live, name, body) : Get(name);
               }) {}
  ~Parts() {
    if (socket >= 0) ::close(socket);
  }

  PageAnswer Get(std::string_view name);
  void Watch();

  PageScene& scene;
  int socket;  // the listening socket; -1 once the daemon has taken it over
  PreviewRender preview;
  LiveView live;
  PageDaemon daemon;
};

PageAnswer PageServer::Parts::Get(std::string_view name) {
  constexpr std::string_view kPreview = "preview/", kLive = "live/";
  if (name.starts_with(kPreview)) return preview.Answer(name.substr(kPreview.size()));
  if (name.starts_with(kLive)) return live.AnswerImage(name.substr(kLive.size()));
  return Answer(scene, name);
}

// Tells pages when the watched render or PATH.yaml has changed.
void PageServer::Parts::Watch() {
  std::string seen;
  std::string path_id = scene.first_draft()->id;
  auto looked = std::chrono::steady_clock::now() - kBetweenLooks;
  while (!scene.events().is_closed()) {
    std::this_thread::sleep_for(milliseconds(50));
    if (std::chrono::steady_clock::now() - looked < kBetweenLooks) continue;
    looked = std::chrono::steady_clock::now();
    if (!scene.arguments().watch.empty()) {
      const std::string now = RenderJson(scene.arguments().watch);
      if (now != std::exchange(seen, now)) scene.events().Post("watch", now);
    }
    const auto text = scene.TextOnDisk();
    if (text && IdOfText(*text) != std::exchange(path_id, IdOfText(*text)))
      scene.events().Post("path", PathNewsJson(scene, *text));
  }
}

PageServer::PageServer(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
PageServer::~PageServer() = default;

Result<std::unique_ptr<PageServer>> PageServer::Open(PageScene& scene, int port,
                                                     std::vector<WebOrigin> allowed_origins) {
  if (FindPageFile("index.html") == nullptr)
    return OutputError(
        "this lfvisualizer was built without its page, because Node.js and npm were missing: "
        "install them, and build it again, or use --text");
  LF_ASSIGN_OR_RETURN(std::string token, MakeToken());
  LF_ASSIGN_OR_RETURN(const PagePort listening, ListenOnThisMachine(port));
  auto parts =
      std::make_unique<Parts>(scene, PageDoor{token, std::move(allowed_origins)}, listening.socket);
  std::unique_ptr<PageServer> server(new PageServer(std::move(parts)));
  server->address_ = fmt::format("http://127.0.0.1:{}/{}/", listening.port, token);
  server->token_ = std::move(token);
  return server;
}

Result<void> PageServer::ServeUntil(const std::atomic<bool>& interrupted) {
  PageDaemon& daemon = parts_->daemon;
  std::thread watcher([&] { parts_->Watch(); });
  Result<void> started = daemon.Start(std::exchange(parts_->socket, -1));
  while (started && !interrupted) {
    std::this_thread::sleep_for(milliseconds(50));
    daemon.HangUpLate();
  }
  parts_->scene.events().Close();
  parts_->live.End();
  daemon.Stop();
  watcher.join();
  return started;
}

}  // namespace lf
