// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/camera_table.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lf/camera/path/camera_facts.h"
#include "lf/core/log.h"

namespace lf {
namespace {

// Returns a number for people, with five digits. Absolute values below 1e-12 are rounding errors
// and become 0.
std::string Brief(double value) {
  constexpr double kNothing = 1e-12;
  return fmt::format("{:.5g}", std::abs(value) < kNothing ? 0.0 : value);
}

// Returns the facts of the camera of a frame and, at the end, of the shutter, if there is one.
std::vector<CameraFact> FactsOf(const CameraPath& path, FrameId frame) {
  RenderCamera camera = path.Camera(frame);
  // The views of a moment are frames of the same time.
  if (path.views > 1)
    camera.time_s =
        static_cast<double>(path.frames().IndexOf(frame) / static_cast<size_t>(path.views)) /
        path.fps;
  std::vector<CameraFact> facts = CameraFacts(camera, frame);
  if (path.shutter.exists())
    facts.push_back({"shutter",
                     {"angle_deg", "samples"},
                     {path.shutter.angle_deg, static_cast<double>(path.shutter.samples)}});
  return facts;
}

std::string Exact(double value) { return fmt::format("{}", value == 0 ? 0.0 : value); }

// A column of the table: one fact about the camera of each frame, as texts [frame][part]. A part is
// a component, such as x.
struct TableColumn {
  CameraFact fact;  // the fact in the first frame
  std::vector<std::vector<std::string>> texts;

  bool IsConstant() const {
    return std::all_of(texts.begin(), texts.end(),
                       [&](const std::vector<std::string>& row) { return row == texts[0]; });
  }
};

std::vector<std::string> BriefTexts(const CameraFact& fact) {
  std::vector<std::string> texts;
  for (const double value : fact.values) texts.push_back(Brief(value));
  return texts;
}

std::vector<TableColumn> Columns(const CameraPath& path, const std::vector<FrameId>& frames) {
  std::vector<TableColumn> columns;
  for (const FrameId frame : frames) {
    const std::vector<CameraFact> facts = FactsOf(path, frame);
    columns.resize(facts.size());
    for (size_t i = 0; i < facts.size(); ++i) {
      if (columns[i].texts.empty()) columns[i].fact = facts[i];
      columns[i].texts.push_back(BriefTexts(facts[i]));
    }
  }
  return columns;
}

std::string BlockLine(const CameraFact& fact) {
  std::string line = fmt::format("{:<21}", fact.name);
  const std::vector<std::string> texts = BriefTexts(fact);
  for (size_t i = 0; i < texts.size(); ++i)
    line += fact.parts.empty() ? " " + texts[i] : fmt::format(" {} {}", fact.parts[i], texts[i]);
  return line + "\n";
}

// Appends a column to the lines of the table: the name of the fact, the names of its parts, and one
// line for each frame.
void AppendColumn(const TableColumn& column, std::vector<std::string>* lines) {
  const CameraFact& fact = column.fact;
  std::vector<size_t> widths;
  size_t width = 0;
  for (size_t part = 0; part < fact.values.size(); ++part) {
    widths.push_back(fact.parts.empty() ? 0 : fact.parts[part].size());
    for (const auto& row : column.texts) widths.back() = std::max(widths.back(), row[part].size());
    width += widths.back() + 2;
  }
  const size_t missing = fact.name.size() + 2 - std::min(fact.name.size() + 2, width);
  widths[0] += missing;
  (*lines)[0] += fmt::format("{:>{}}", fact.name, width + missing);
  for (size_t part = 0; part < widths.size(); ++part) {
    const std::string name = fact.parts.empty() ? "" : fact.parts[part];
    (*lines)[1] += fmt::format("{:>{}}", name, widths[part] + 2);
    for (size_t row = 0; row < column.texts.size(); ++row)
      (*lines)[2 + row] += fmt::format("{:>{}}", column.texts[row][part], widths[part] + 2);
  }
}

nlohmann::ordered_json JsonOf(const CameraFact& fact) {
  const auto number = [](double value) -> nlohmann::ordered_json {
    if (!std::isfinite(value)) return nullptr;
    if (value == std::floor(value) && std::abs(value) < 1e9) return static_cast<int64_t>(value);
    return value;
  };
  if (fact.parts.empty()) return number(fact.values[0]);
  nlohmann::ordered_json values = nlohmann::ordered_json::array();
  for (const double value : fact.values) values.push_back(number(value));
  return values;
}

}  // namespace

std::string CameraTable(const CameraPath& path, const std::vector<FrameId>& frames) {
  std::string constants;
  std::vector<std::string> lines(2 + frames.size());
  for (const TableColumn& column : Columns(path, frames)) {
    if (column.fact.name != "frame" && column.IsConstant())
      constants += BlockLine(column.fact);
    else
      AppendColumn(column, &lines);
  }
  std::string table = constants + "\n";
  for (std::string& line : lines) {
    line.erase(line.find_last_not_of(' ') + 1);
    table += line + "\n";
  }
  return table;
}

std::string CameraBlock(const CameraPath& path, FrameId frame) {
  std::string block;
  for (const CameraFact& fact : FactsOf(path, frame)) block += BlockLine(fact);
  return block;
}

std::string CameraCsv(const CameraPath& path, const std::vector<FrameId>& frames) {
  std::string csv;
  const auto add = [&](const std::string& cell) {
    if (!csv.empty() && csv.back() != '\n') csv += ',';
    csv += cell;
  };
  for (const CameraFact& fact : FactsOf(path, frames.front())) {
    if (fact.parts.empty()) add(fact.name);
    for (const std::string& part : fact.parts) add(fact.name + "." + part);
  }
  csv += '\n';
  for (const FrameId frame : frames) {
    for (const CameraFact& fact : FactsOf(path, frame))
      for (const double value : fact.values) add(Exact(value));
    csv += '\n';
  }
  return csv;
}

std::string CameraJson(const CameraPath& path, const std::vector<FrameId>& frames) {
  const Intrinsics& intrinsics = path.cameras.front().pinhole.intrinsics;
  nlohmann::ordered_json json = {{"fps", path.fps},
                                 {"frames", path.frame_count()},
                                 {"first_frame", path.first_frame},
                                 {"resolution", {intrinsics.width_px, intrinsics.height_px}},
                                 {"unit_m", path.unit_m}};
  nlohmann::ordered_json& cameras = json["cameras"] = nlohmann::ordered_json::array();
  for (const FrameId frame : frames) {
    nlohmann::ordered_json camera;
    for (const CameraFact& fact : FactsOf(path, frame)) camera[fact.name] = JsonOf(fact);
    cameras.push_back(std::move(camera));
  }
  return json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace lf
