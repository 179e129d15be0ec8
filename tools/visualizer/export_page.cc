// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/export_page.h"

#include <fmt/format.h>

#include <chrono>
#include <iterator>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "tools/visualizer/export_live.h"
#include "tools/visualizer/page_answers.h"
#include "tools/visualizer/page_files.h"

#include "lf/core/check.h"
#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/core/output_files.h"
#include "lf/view/shown_frames.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

std::string Base64Of(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const std::string_view three = bytes.substr(i, 3);
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (k < three.size() ? static_cast<unsigned char>(three[k]) : 0U);
    for (size_t k = 0; k < 4; ++k)
      text += k <= three.size() ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

// Returns index.html, marked so that the page loads data as scripts.
std::string MarkedPage(std::string_view html) {
  constexpr std::string_view kBefore = "<html lang=\"en\"";
  std::string marked(html);
  const size_t at = marked.find(kBefore);
  LF_CHECK(at != std::string::npos);
  return marked.insert(at + kBefore.size(), " data-files=\"scripts\"");
}

// kUsage if the folder has more than `known` files.
Result<void> CheckIsNew(const fs::path& folder, std::ptrdiff_t known) {
  std::error_code error;
  if (!fs::exists(folder, error)) return {};
  const fs::directory_iterator files(folder, error);
  if (!error && std::distance(begin(files), end(files)) <= known) return {};
  return UsageError(fmt::format("--export {}: exists already and is not empty; give a new folder",
                                folder.string()));
}

Error Interrupted() { return {ErrorKind::kInterrupted, "interrupted; the export is incomplete"}; }

class Exporter {
 public:
  Exporter(PageScene& scene, const fs::path& folder) : scene_(scene), folder_(folder) {}

  Result<void> Write(const std::string& name, std::string_view bytes) {
    const fs::path path = folder_ / name;
    LF_RETURN_IF_ERROR(CreateFolder(path.parent_path()));
    LF_RETURN_IF_ERROR(WriteFileAtomically(path, bytes));
    ++facts.file_count;
    facts.byte_count += bytes.size();
    return {};
  }
  // Writes data as a script that hands them to the page (web/src/data/source.ts).
  Result<void> WriteData(const std::string& name, std::string_view bytes) {
    return Write(name + ".js",
                 fmt::format("lfvisualizerFile(\"{}\",\"{}\")\n", name, Base64Of(bytes)));
  }
  // Writes the answer that the server would give for this name. Warns if the answer is an error.
  Result<void> WriteAnswer(const std::string& name) {
    const PageAnswer answer = Answer(scene_, name);
    if (answer.status == 200) return WriteData(name, answer.body);
    LogWarning("{}: {}", name, answer.fault);
    return {};
  }
  // Writes the large picture of an LF image. An unreadable LF image is left out and counted.
  Result<void> WriteImage(uint32_t id) {
    const std::string name = fmt::format("image/{}/{}.jpg", kLargeSide_px, id);
    const PageAnswer answer = Answer(scene_, name);
    ++facts.image_count;
    if (answer.status == 200) return Write(name, answer.body);
    if (facts.missing_count++ == 0) facts.first_missing = answer.fault;
    return {};
  }
  // Writes an LF image for live pictures. Returns the name of its data; "" if it cannot be read.
  Result<std::string> WriteLive(const LivePlan& plan, LfImageId id) {
    const auto encoded = EncodeForLive(scene_, plan, id);
    if (!encoded) {
      LogWarning("{}", encoded.error().message);
      return std::string();
    }
    const std::string name = fmt::format("live/{}{}", id.value, encoded->ending);
    const uint64_t before = facts.byte_count;
    LF_RETURN_IF_ERROR(WriteData(name, encoded->bytes));
    facts.live_bytes += facts.byte_count - before;
    ++facts.live_count;
    return name;
  }

  ExportFacts facts;

 private:
  PageScene& scene_;
  const fs::path& folder_;
};

}  // namespace

Result<ExportFacts> ExportPage(PageScene& scene, const fs::path& folder, size_t most_images,
                               size_t most_live_bytes, const std::atomic<bool>& interrupted,
                               const std::function<void(size_t, size_t)>& progress) {
  LF_RETURN_IF_ERROR(CheckIsNew(folder, 0));
  if (PageFiles().empty())
    return OutputError(
        "this lfvisualizer was built without its page, because Node.js and npm were missing: "
        "install them, and build it again");
  LF_ASSIGN_OR_RETURN(const FileLock lock, LockOutputFolder(folder));
  LF_RETURN_IF_ERROR(CheckIsNew(folder, 1));  // another export may have ended just now
  Exporter exporter(scene, folder);
  PathDraft& draft = *scene.first_draft();
  const std::string base = fmt::format("path/{}/", draft.id);
  const std::shared_ptr<FilmUse> film = scene.FilmOf(draft);
  const std::vector<FrameId> frames = ShownFrames(draft.path->frames());
  const size_t frame_count = frames.size();
  if (frame_count < draft.path->frame_count())
    LogWarning("{}: the film has {} frames: the export shows {} of them: every {}-th, and the last",
               scene.arguments().path.string(), draft.path->frame_count(), frame_count,
               ShownStep(draft.path->frame_count()));
  for (size_t asked = 0; asked < frame_count; asked = film->Get().frames_done) {
    progress(asked, 2 * frame_count);
    if (interrupted) return Interrupted();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  const std::vector<uint16_t> frames_of_image = film->Get().frames_of_image;
  std::vector<uint32_t> images;
  for (uint32_t i = 0; i < frames_of_image.size(); ++i)
    if (frames_of_image[i] > 0) images.push_back(i);
  // The exported LF images are spread evenly over the LF images that the film uses.
  const size_t image_count = std::min(images.size(), most_images);
  const LivePlan live = PlanLiveExport(scene, images, most_live_bytes);
  const size_t total = 2 * frame_count + image_count + live.ids.size();
  size_t done = frame_count;
  const auto step = [&]() -> Result<void> {
    progress(++done, total);
    if (interrupted) return Interrupted();
    return {};
  };
  for (const char* name : {"cameras.bin"}) LF_RETURN_IF_ERROR(exporter.WriteAnswer(name));
  for (const char* name : {"path.json", "path.yaml", "frames.bin", "film.json", "film.bin"})
    LF_RETURN_IF_ERROR(exporter.WriteAnswer(base + name));
  for (size_t i = 0; i < scene.depths().size(); ++i)
    LF_RETURN_IF_ERROR(exporter.WriteAnswer(fmt::format("depth/{}.bin", i)));
  for (const FrameId frame : frames) {
    LF_RETURN_IF_ERROR(exporter.WriteAnswer(fmt::format("{}use/{}.bin", base, frame.value)));
    LF_RETURN_IF_ERROR(exporter.WriteAnswer(fmt::format("{}density/{}.json", base, frame.value)));
    LF_RETURN_IF_ERROR(step());
  }
  for (size_t i = 0; i < image_count; ++i) {
    const uint32_t id = images[i * images.size() / image_count];
    LF_RETURN_IF_ERROR(exporter.WriteAnswer(fmt::format("camera/{}.json", id)));
    LF_RETURN_IF_ERROR(exporter.WriteImage(id));
    LF_RETURN_IF_ERROR(step());
  }
  std::vector<std::string> live_names;
  for (const LfImageId id : live.ids) {
    LF_ASSIGN_OR_RETURN(live_names.emplace_back(), exporter.WriteLive(live, id));
    LF_RETURN_IF_ERROR(step());
  }
  LF_RETURN_IF_ERROR(exporter.WriteData("live.json", LiveJson(scene, live, live_names)));
  // The page is written last, so that an incomplete export does not open.
  LF_RETURN_IF_ERROR(
      exporter.WriteData("scene.json", SceneJson(scene, draft, {.is_server = false})));
  for (const PageFile& file : PageFiles())
    LF_RETURN_IF_ERROR(exporter.Write(file.name, file.name == std::string_view("index.html")
                                                     ? MarkedPage(file.bytes)
                                                     : std::string(file.bytes)));
  return exporter.facts;
}

}  // namespace lf
