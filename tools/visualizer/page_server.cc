#include "tools/visualizer/page_server.h"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/random.h>

#include <array>
#include <chrono>
#include <exception>
#include <memory>
#include <thread>
#include <utility>

#include "tools/visualizer/page_answers.h"
#include "tools/visualizer/page_edits.h"
#include "tools/visualizer/page_files.h"
#include "tools/visualizer/preview_render.h"
#include "tools/visualizer/render_folder.h"

namespace lf {
namespace {

using std::chrono::milliseconds;

// Each page that is open holds a thread with its stream of events.
constexpr int kMostStreams = 16;
constexpr size_t kThreads = kMostStreams + 8;
constexpr size_t kMostBytes = size_t{9} << 20;  // of a path: 8 MiB, and JSON around it
constexpr milliseconds kBetweenLooks(400), kHeartbeat(1000);

Result<std::string> MakeToken() {
  std::array<unsigned char, 16> bytes;
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    return OutputError("the system gives no random numbers for the address");
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

// In a time that does not tell where they differ.
bool AreEqual(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned char difference = 0;
  for (size_t i = 0; i < a.size(); ++i)
    difference = static_cast<unsigned char>(difference | (a[i] ^ b[i]));
  return difference == 0;
}

// As they are: httplib would compress what set_content() is given, for seconds where a browser
// takes brotli, and bytes do not leave this machine.
void SendBytes(std::string_view bytes, const char* type, std::shared_ptr<const std::string> owner,
               httplib::Response& response) {
  if (bytes.empty()) return response.set_content("", type);
  response.set_content_provider(
      bytes.size(), type,
      [bytes, owner = std::move(owner)](size_t offset, size_t length, httplib::DataSink& sink) {
        return sink.write(bytes.data() + offset, length);
      });
}

void Send(PageAnswer answer, httplib::Response& response) {
  response.status = answer.status;
  const auto body = std::make_shared<const std::string>(std::move(answer.body));
  SendBytes(*body, answer.type.c_str(), body, response);
}

}  // namespace

struct PageServer::Parts {
  Parts(PageScene& page_scene, std::string page_token)
      : scene(page_scene),
        token(std::move(page_token)),
        preview(page_scene.arguments(), page_scene.events()) {}

  void Route();
  bool IsAllowed(const httplib::Request& request, httplib::Response& response) const;
  void Get(std::string_view name, httplib::Response& response);
  void Stream(httplib::Response& response);
  void Watch();

  PageScene& scene;
  const std::string token;
  int port = 0;
  PreviewRender preview;
  httplib::Server server;
  std::atomic<int> stream_count = 0;
};

// The token is a folder of the address: all that a page asks for lies below it.
bool PageServer::Parts::IsAllowed(const httplib::Request& request,
                                  httplib::Response& response) const {
  const std::string host = request.get_header_value("Host");
  if (host != fmt::format("127.0.0.1:{}", port) && host != fmt::format("localhost:{}", port)) {
    Send(Refusal(403, "this address is not served"), response);
    return false;
  }
  const std::string_view path = request.path;
  if (path.size() < token.size() + 2 || path[0] != '/' || path[token.size() + 1] != '/' ||
      !AreEqual(path.substr(1, token.size()), token)) {
    Send(Refusal(403,
                 "the address has no token, or a wrong one: open the one that lfvisualizer "
                 "has printed"),
         response);
    return false;
  }
  for (const std::string_view text :
       {std::string_view(request.path), std::string_view(request.target)})
    if (text.find("..") != std::string_view::npos || text.find('\\') != std::string_view::npos ||
        text.find('\0') != std::string_view::npos) {
      Send(Refusal(403, "there is nothing outside"), response);
      return false;
    }
  return true;
}

void PageServer::Parts::Stream(httplib::Response& response) {
  if (++stream_count > kMostStreams) {
    --stream_count;
    return Send(Refusal(503, "too many pages are open: close some"), response);
  }
  response.set_chunked_content_provider(
      "text/event-stream",
      [this, seen = uint64_t{0}, is_first = true](size_t, httplib::DataSink& sink) mutable {
        // At once, so that the page knows that it is connected; then so often that a page that has
        // gone is noticed.
        std::string text = std::exchange(is_first, false)
                               ? std::string(": hello\n\n")
                               : scene.events().WaitForNews(&seen, kHeartbeat);
        if (scene.events().is_closed()) {
          sink.done();
          return true;
        }
        if (text.empty()) text = ": still here\n\n";
        return sink.write(text.data(), text.size());
      },
      [this](bool) { --stream_count; });
}

void PageServer::Parts::Get(std::string_view name, httplib::Response& response) {
  if (name == "events") return Stream(response);
  if (const PageFile* file = FindPageFile(name.empty() ? "index.html" : name)) {
    return SendBytes(file->bytes, file->type, nullptr, response);
  }
  constexpr std::string_view kPreview = "preview/";
  if (name.starts_with(kPreview))
    return Send(AnswerOfRender(preview.folder(), name.substr(kPreview.size())), response);
  Send(Answer(scene, name), response);
}

void PageServer::Parts::Route() {
  // httplib's own choice would share the port with another lfvisualizer.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  });
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  server.set_payload_max_length(kMostBytes);
  server.set_tcp_nodelay(true);
  server.set_keep_alive_timeout(2);
  server.set_default_headers({{"Cache-Control", "no-store"},
                              {"Referrer-Policy", "no-referrer"},
                              {"X-Content-Type-Options", "nosniff"},
                              {"Content-Security-Policy",
                               "default-src 'self'; img-src 'self' blob: data:; style-src 'self' "
                               "'unsafe-inline'; frame-ancestors 'none'; base-uri 'none'"}});
  server.set_exception_handler(
      [](const httplib::Request&, httplib::Response& response, const std::exception_ptr& thrown) {
        try {
          std::rethrow_exception(thrown);
        } catch (const std::exception& exception) {
          Send(Refusal(500, std::string("failed: ") + exception.what()), response);
        } catch (...) {
          Send(Refusal(500, "failed"), response);
        }
      });
  server.Get(".*", [this](const httplib::Request& request, httplib::Response& response) {
    if (!IsAllowed(request, response)) return;
    Get(std::string_view(request.path).substr(token.size() + 2), response);
  });
  server.Post(".*", [this](const httplib::Request& request, httplib::Response& response) {
    if (!IsAllowed(request, response)) return;
    Send(
        Edit(scene, preview, std::string_view(request.path).substr(token.size() + 2), request.body),
        response);
  });
}

// Tells pages when the watched render has something new.
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

Result<std::unique_ptr<PageServer>> PageServer::Open(PageScene& scene, int port) {
  if (FindPageFile("index.html") == nullptr)
    return OutputError(
        "this lfvisualizer was built without its page: Node.js and npm were missing. "
        "--text works");
  LF_ASSIGN_OR_RETURN(std::string token, MakeToken());
  auto parts = std::make_unique<Parts>(scene, std::move(token));
  parts->Route();
  parts->port = port == 0 ? parts->server.bind_to_any_port("127.0.0.1")
                          : (parts->server.bind_to_port("127.0.0.1", port) ? port : -1);
  if (parts->port < 0)
    return OutputError(fmt::format(
        "--serve {}: the port cannot be had; another program may listen there. 0 takes any", port));
  std::unique_ptr<PageServer> server(new PageServer(std::move(parts)));
  server->address_ =
      fmt::format("http://127.0.0.1:{}/{}/", server->parts_->port, server->parts_->token);
  return server;
}

Result<void> PageServer::ServeUntil(const std::atomic<bool>& interrupted) {
  bool is_listening = false;
  std::thread listener([&] { is_listening = parts_->server.listen_after_bind(); });
  std::thread watcher([&] { parts_->Watch(); });
  while (!interrupted) std::this_thread::sleep_for(milliseconds(50));
  parts_->scene.events().Close();
  parts_->server.stop();
  listener.join();
  watcher.join();
  if (!is_listening) return OutputError("the page cannot be served");
  return {};
}

}  // namespace lf
