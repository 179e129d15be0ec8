#include "tools/visualizer/preview_render.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "tools/visualizer/render_folder.h"

#include "lf/cluster/command.h"
#include "lf/core/file.h"

namespace lf {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

constexpr milliseconds kBetweenLooks(150);
constexpr size_t kMostComplaints = 1 << 20;

// Returns lfrenderer in this program's folder, or the one in PATH.
std::string Renderer() {
  std::error_code error;
  const fs::path beside = fs::read_symlink("/proc/self/exe", error).parent_path() / "lfrenderer";
  return !error && fs::exists(beside, error) ? beside.string() : "lfrenderer";
}

std::vector<std::string> WordsOf(const PageArguments& arguments, const fs::path& path,
                                 const fs::path& frames, FrameId frame) {
  std::vector<std::string> words = {Renderer(), arguments.light_field, path.string()};
  const auto add = [&](std::initializer_list<std::string> more) {
    words.insert(words.end(), more);
  };
  words.insert(words.end(), arguments.light_field_options.begin(),
               arguments.light_field_options.end());
  add({"-o", frames.string(), "--frames", std::to_string(frame.value)});
  add({"--dump-every", "1s", "--no-contact-sheet", "--progress", "none", "--quiet"});
  add({"--memory", "1G", "--seed", std::to_string(arguments.seed)});
  add({"--threads", std::to_string(arguments.threads)});
  add({"--estimator", arguments.estimator, "--lens-weights", arguments.lens_weights});
  if (arguments.needs.max_image_count)
    add({"--max-images", std::to_string(*arguments.needs.max_image_count)});
  if (arguments.max_angle_deg > 0) add({"--max-angle", fmt::format("{}", arguments.max_angle_deg)});
  return words;
}

// Returns the last line that is not empty.
std::string LastLine(const fs::path& file) {
  auto text = ReadFile(file, kMostComplaints);
  if (!text) return "it said nothing";
  while (!text->empty() && text->back() == '\n') text->pop_back();
  const size_t begin = text->rfind('\n');
  const std::string line = begin == std::string::npos ? *text : text->substr(begin + 1);
  constexpr std::string_view kPrefix = "error: ";
  return line.starts_with(kPrefix) ? line.substr(kPrefix.size()) : line;
}

}  // namespace

PreviewRender::PreviewRender(const PageArguments& arguments, EventBoard& events)
    : arguments_(arguments), events_(events), thread_([this] { Run(); }) {}

PreviewRender::~PreviewRender() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
    changed_.notify_all();
  }
  thread_.join();
  std::error_code ignored;
  if (!root_.empty()) fs::remove_all(root_, ignored);
}

void PreviewRender::Start(const std::string& text, FrameId frame) {
  const std::lock_guard lock(mutex_);
  wish_ = {text, frame};
  changed_.notify_all();
}

void PreviewRender::Stop() {
  const std::lock_guard lock(mutex_);
  wish_.reset();
  is_stopped_ = true;
  changed_.notify_all();
}

fs::path PreviewRender::folder() const {
  const std::lock_guard lock(mutex_);
  return folder_;
}

bool PreviewRender::IsSuperseded() {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, kBetweenLooks, [&] { return is_ending_ || is_stopped_ || wish_; });
}

void PreviewRender::Run() {
  while (true) {
    Wish wish;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return is_ending_ || wish_; });
      if (is_ending_) return;
      wish = *std::exchange(wish_, std::nullopt);
      is_stopped_ = false;
    }
    Render(wish);
  }
}

void PreviewRender::Render(const Wish& wish) {
  if (root_.empty()) {
    std::string name = (fs::temp_directory_path() / "lfvisualizer-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) return Say(wish, "failed", name + ": no such folder");
    root_ = name;
  }
  const fs::path frames = root_ / fmt::format("preview-{}", ++count_);
  const fs::path path = root_ / "path.yaml", complaints = root_ / "complaints.txt";
  if (const auto written = WriteFileAtomically(path, wish.text); !written)
    return Say(wish, "failed", written.error().message);
  {
    const std::lock_guard lock(mutex_);
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
    folder_ = frames;
  }
  const int file = ::open(complaints.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  auto command = Command::Start({.words = WordsOf(arguments_, path, frames, wish.frame),
                                 .working_folder = {},
                                 .output = -1,
                                 .complaints = file,
                                 .kept = -1});
  if (file >= 0) ::close(file);
  if (!command) return Say(wish, "failed", command.error().message);
  Say(wish, "rendering", "");
  std::string seen;
  std::optional<CommandEnd> end;
  while (!(end = (*command)->Poll())) {
    if (IsSuperseded()) return Say(wish, "stopped", "");  // ~Command() kills lfrenderer
    const std::string now = RenderJson(frames);
    if (now != std::exchange(seen, now)) Say(wish, "rendering", "");
  }
  if (end->exit_code == 0 && end->signal == 0) return Say(wish, "finished", "");
  // The picture is complete except for LF images that are missing or broken.
  constexpr int kBelow = static_cast<int>(ErrorKind::kBelowRequired);
  if (end->exit_code == kBelow) return Say(wish, "finished", LastLine(complaints));
  Say(wish, "failed",
      end->signal != 0 ? fmt::format("lfrenderer died of signal {}", end->signal)
                       : LastLine(complaints));
}

void PreviewRender::Say(const Wish& wish, const std::string& state, const std::string& message) {
  std::string changed;
  const auto render = nlohmann::json::parse(RenderJson(folder()), nullptr, false);
  if (render.is_object() && !render["frames"].empty()) changed = render["frames"][0]["changed"];
  const nlohmann::ordered_json json = {
      {"frame", wish.frame.value}, {"state", state}, {"message", message}, {"changed", changed}};
  events_.Post("preview", json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace lf
