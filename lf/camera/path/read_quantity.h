// SPDX-License-Identifier: Apache-2.0
// Reads the quantities of a path file that may change over time: their *start* (the value at time
// 0) and their speed from a section of the file, and their `accelerations` or `keyframes`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lf/camera/path/path_description.h"
#include "lf/camera/path/read_value.h"
#include "lf/camera/path/yaml_schema.h"

namespace lf {

// Units that a quantity may have in the file. Its key is the quantity's name with the suffix of the
// unit, such as "focus_distance_mm"; a length in world units has no suffix. kDegreesUnsaid: the
// unit is degrees, but the key has no suffix.
enum class QuantityUnit { kNone, kLength, kDegrees, kDegreesUnsaid };

struct QuantitySpec {
  std::string name;
  ValueShape shape = ValueShape::kNumber;
  QuantityUnit unit = QuantityUnit::kNone;
  NumberRange range = {};
  bool zero_if_not_given = false;
};

class QuantityReader {
 public:
  //   keyframes, accelerations   the entries of the file with these keys; null if missing
  //   unit_m                     metres per world unit
  QuantityReader(const YamlEntry* keyframes, const YamlEntry* accelerations, double unit_m,
                 YamlErrors* errors);

  // Returns the quantity. If the file does not state it, returns a constant 0 if
  // spec.zero_if_not_given is true, otherwise none. Returns none, and adds an error, if the file
  // states it wrongly. The quantity's start and speed are keys of `section`. If it has keyframes
  // but none at time 0, its start, if any, becomes the keyframe at time 0.
  std::optional<Quantity> Read(YamlMap* section, const QuantitySpec& spec);

  // Returns a length that does not change over time and is stated in world units or in millimetres;
  // none if the file does not state it, or if it states it wrongly (then an error is added).
  std::optional<double> ReadFixedLength(YamlMap* section, const std::string& name,
                                        const NumberRange& range);

  // Reports keyframes and accelerations of unknown quantities. Must be called after the last
  // quantity is read.
  void CheckKeys();

 private:
  struct UnitEnding {
    std::string ending;
    double units_per_file = 1;
  };
  struct Acceleration {
    YamlPlace place;
    std::string quantity;
    const YamlNode* value = nullptr;
    double from_s = 0;
    double to_s = 0;
    bool read = false;
  };
  struct Given {  // an entry of the file, and the unit that its key states
    const YamlEntry* entry = nullptr;
    std::string label;
    double units_per_file = 1;
    explicit operator bool() const { return entry != nullptr; }
  };

  void ReadAccelerations(const YamlNode& node);
  std::vector<UnitEnding> Endings(QuantityUnit unit) const;
  Given FindInOneUnit(YamlMap* map, const std::string& name, QuantityUnit unit);
  // Returns the quantity without its motion. `given` is the entry of its keyframes or start, if it
  // has any.
  Quantity Unmoved(const YamlMap& section, const QuantitySpec& spec, const Given& given) const;
  // Returns the periods of the quantity's accelerations. If there are any, sets `place` to the
  // position of one of them in the file.
  std::vector<AccelerationPeriod> TakePeriods(const QuantitySpec& spec, YamlPlace* place);
  std::optional<AcceleratedMotion> ReadAccelerated(const QuantitySpec& spec, const Given& start,
                                                   const Given& speed,
                                                   std::vector<AccelerationPeriod> periods);
  std::optional<KeyframeCurve> ReadKeyframes(const QuantitySpec& spec, const Given& start,
                                             const Given& keyframes);
  std::optional<Key> ReadKey(const YamlNode& node, const QuantitySpec& spec,
                             const Given& keyframes);
  bool AddStartAsKey(const QuantitySpec& spec, const Given& start, std::vector<Key>* keys);

  double unit_m_;
  YamlErrors* errors_;
  YamlMap keyframes_;
  std::vector<Acceleration> accelerations_;
  // Keys, with the suffix of the unit, of the quantities read so far that may accelerate.
  std::vector<std::string> accelerable_;
};

}  // namespace lf
