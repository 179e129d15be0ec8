// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/hdf5_array.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "lf/core/shell_word.h"

namespace lf {
namespace {

// Returns the command that writes the array as a file of NumPy.
std::string SaveCommand(const std::filesystem::path& file) {
  return ShellCommand({"python3", "-c",
                       "import sys, h5py, numpy; numpy.save(sys.argv[2], "
                       "h5py.File(sys.argv[1])['LF'][...])",
                       FileArgument(file),
                       FileArgument(std::filesystem::path(file).replace_extension(".npy"))});
}

}  // namespace
}  // namespace lf

#ifdef LF_HDF5_LIBRARY_NAME
#include <hdf5.h>
#include <sys/stat.h>

#include <algorithm>
#include <mutex>
#include <optional>
#include <tuple>
#include <utility>

#include "lf/core/loaded_library.h"
#include "lf/pixels/files/picture_decoder.h"
#include "lf/pixels/files/views_shape.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

struct Hdf5Calls {
  LoadedLibrary library{LF_HDF5_LIBRARY_NAME};
  LF_LOADED(H5open);
  LF_LOADED(H5Eset_auto2);
  LF_LOADED(H5Ewalk2);
  LF_LOADED(H5Fopen);
  LF_LOADED(H5Fclose);
  LF_LOADED(H5Gget_info);
  LF_LOADED(H5Lexists);
  LF_LOADED(H5Lget_name_by_idx);
  LF_LOADED(H5Dopen2);
  LF_LOADED(H5Dclose);
  LF_LOADED(H5Dget_space);
  LF_LOADED(H5Dget_type);
  LF_LOADED(H5Dget_create_plist);
  LF_LOADED(H5Dread);
  LF_LOADED(H5Pcreate);
  LF_LOADED(H5Pclose);
  LF_LOADED(H5Pget_layout);
  LF_LOADED(H5Pget_chunk);
  LF_LOADED(H5Pset_chunk_cache);
  LF_LOADED(H5Screate_simple);
  LF_LOADED(H5Sget_simple_extent_dims);
  LF_LOADED(H5Sget_simple_extent_ndims);
  LF_LOADED(H5Sget_simple_extent_npoints);
  LF_LOADED(H5Sselect_hyperslab);
  LF_LOADED(H5Sclose);
  LF_LOADED(H5Tget_class);
  LF_LOADED(H5Tget_sign);
  LF_LOADED(H5Tget_size);
  LF_LOADED(H5Tclose);
  LF_LOADED(H5Aexists);
  LF_LOADED(H5Aopen);
  LF_LOADED(H5Aget_space);
  LF_LOADED(H5Aget_type);
  LF_LOADED(H5Aread);
  LF_LOADED(H5Aclose);
  // Types in memory, and the class of property lists that set the cache of chunks.
  LF_LOADED(H5T_NATIVE_UINT8_g);
  LF_LOADED(H5T_NATIVE_UINT16_g);
  LF_LOADED(H5T_NATIVE_FLOAT_g);
  LF_LOADED(H5T_NATIVE_DOUBLE_g);
  LF_LOADED(H5P_CLS_DATASET_ACCESS_ID_g);
};

const Hdf5Calls& Hdf5() {
  static const Hdf5Calls calls = [] {
    Hdf5Calls found;
    if (found.library.has_all()) {
      found.H5open();
      // Its messages become a part of ours.
      found.H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    return found;
  }();
  return calls;
}

// An object of libhdf5, which is closed when it is no longer needed.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept
      : id_(std::exchange(other.id_, -1)), close_(std::exchange(other.close_, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0 && close_ != nullptr) close_(id_);
  }
  bool is_open() const { return id_ >= 0; }
  hid_t id() const { return id_; }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

// Returns what libhdf5 says of its last failure.
std::string LastFailure() {
  std::string text;
  const auto take = [](unsigned /*index*/, const H5E_error2_t* error, void* to) -> herr_t {
    auto* const said = static_cast<std::string*>(to);
    if (said->empty() && error->desc != nullptr) *said = error->desc;
    return 0;
  };
  Hdf5().H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take, &text);
  return text.empty() ? "libhdf5 states no reason" : text;
}

Error Damaged(const std::string& name) {
  return InputError(fmt::format("{}: truncated or damaged HDF5 file: {}: copy or save it again",
                                name, LastFailure()));
}

// Returns the names of the first objects of a file, as a message lists them.
std::string NamesIn(hid_t file) {
  constexpr hsize_t kMostNames = 5;
  H5G_info_t group{};
  if (Hdf5().H5Gget_info(file, &group) < 0 || group.nlinks == 0) return "nothing";
  std::vector<std::string> names;
  for (hsize_t i = 0; i < std::min(group.nlinks, kMostNames); ++i) {
    char name[81] = "";
    if (Hdf5().H5Lget_name_by_idx(file, ".", H5_INDEX_NAME, H5_ITER_INC, i, name, sizeof name, 0) >=
        0)
      names.emplace_back(name);
  }
  for (std::string& name : names)
    for (char& c : name)
      if (c < ' ' || c > '~') c = '?';
  return fmt::format("{}{}", fmt::join(names, ", "), group.nlinks > kMostNames ? ", ..." : "");
}

// H5F_ACC_RDONLY, whose macro would link libhdf5.
constexpr unsigned kReadOnly = 0;

char KindOf(hid_t type) {
  switch (Hdf5().H5Tget_class(type)) {
    case H5T_INTEGER:
      return Hdf5().H5Tget_sign(type) == H5T_SGN_NONE ? 'u' : 'i';
    case H5T_FLOAT:
      return 'f';
    default:
      return '?';
  }
}

// A file whose dataset is open.
struct OpenFile {
  Handle file, dataset;
  ViewArray array;
};

Result<OpenFile> Open(const fs::path& path) {
  const Hdf5Calls& hdf5 = Hdf5();
  const std::string name = path.string();
  if (!hdf5.library.has_all())
    return InputError(
        fmt::format("{}: HDF5 files need {}, which is not installed here: install it (package "
                    "libhdf5-103-1 of Debian), or save the array as a file of NumPy where h5py is: "
                    "{}",
                    name, LF_HDF5_LIBRARY_NAME, SaveCommand(path)));
  OpenFile open;
  open.file = Handle(hdf5.H5Fopen(path.c_str(), kReadOnly, H5P_DEFAULT), hdf5.H5Fclose);
  if (!open.file.is_open()) return Damaged(name);
  const char* dataset_name = nullptr;
  for (const char* candidate : {"views", "LF"})
    if (hdf5.H5Lexists(open.file.id(), candidate, H5P_DEFAULT) > 0) dataset_name = candidate;
  if (dataset_name == nullptr)
    return InputError(fmt::format(
        "{}: holds no dataset LF, but {}: expected the views of a grid of cameras as the dataset "
        "LF, (rows, columns, height, width, channels); if another dataset holds them, save it as a "
        "file of NumPy (.npy), and give that",
        name, NamesIn(open.file.id())));
  Handle dataset(hdf5.H5Dopen2(open.file.id(), dataset_name, H5P_DEFAULT), hdf5.H5Dclose);
  if (!dataset.is_open()) return Damaged(name);
  const Handle space(hdf5.H5Dget_space(dataset.id()), hdf5.H5Sclose);
  const Handle type(hdf5.H5Dget_type(dataset.id()), hdf5.H5Tclose);
  const Handle properties(hdf5.H5Dget_create_plist(dataset.id()), hdf5.H5Pclose);
  if (!space.is_open() || !type.is_open() || !properties.is_open()) return Damaged(name);
  const int dimensions = hdf5.H5Sget_simple_extent_ndims(space.id());
  hsize_t sizes[H5S_MAX_RANK] = {};
  if (dimensions < 0 || hdf5.H5Sget_simple_extent_dims(space.id(), sizes, nullptr) < 0)
    return Damaged(name);
  Hdf5Dataset head;
  head.shape.assign(sizes, sizes + dimensions);
  head.kind = KindOf(type.id());
  head.value_bytes = hdf5.H5Tget_size(type.id());
  if (hdf5.H5Pget_layout(properties.id()) == H5D_CHUNKED &&
      hdf5.H5Pget_chunk(properties.id(), H5S_MAX_RANK, sizes) == dimensions)
    head.chunk.assign(sizes, sizes + dimensions);
  LF_ASSIGN_OR_RETURN(open.array, ViewArrayOfDataset(head, name));
  if (head.chunk.empty()) {
    open.dataset = std::move(dataset);
    return open;
  }
  // Opened again with a cache that holds the chunks of a view: without it, each would be decoded
  // anew for each part of the view and, if it holds several views, for each of them.
  const Handle access(hdf5.H5Pcreate(*hdf5.H5P_CLS_DATASET_ACCESS_ID_g), hdf5.H5Pclose);
  constexpr size_t kSlots = 12421;  // a prime number, which spreads chunks evenly
  hdf5.H5Pset_chunk_cache(access.id(), kSlots, open.array.cache_bytes, H5D_CHUNK_CACHE_W0_DEFAULT);
  dataset = Handle();
  open.dataset = Handle(hdf5.H5Dopen2(open.file.id(), dataset_name, access.id()), hdf5.H5Dclose);
  if (!open.dataset.is_open()) return Damaged(name);
  return open;
}

// The file that is kept open, and its state when it was opened. All calls of libhdf5 are made while
// `mutex` is locked, because its builds need not allow several threads.
struct KeptFile {
  using State = std::tuple<std::string, int64_t, int64_t, int64_t, uint64_t>;
  std::mutex mutex;
  State state;
  std::optional<OpenFile> open;
};

KeptFile& Kept() {
  // Never destroyed: libhdf5 closes its files before, when the program ends.
  static KeptFile& file = *new KeptFile;
  return file;
}

// Returns the open file; the mutex of Kept() must be locked.
Result<const OpenFile*> OpenKept(const fs::path& path) {
  KeptFile& kept = Kept();
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0)
    return InputError(fmt::format("{}: no such file", path.string()));
  const KeptFile::State state = {path.string(), status.st_mtim.tv_sec, status.st_mtim.tv_nsec,
                                 status.st_size, status.st_ino};
  if (!kept.open || kept.state != state) {
    kept.open.reset();
    LF_ASSIGN_OR_RETURN(kept.open, Open(path));
    kept.state = state;
  }
  return &*kept.open;
}

// Adds an attribute of an object, if it has it.
Result<void> AddAttribute(hid_t object, const char* name, const std::string& file,
                          Hdf5Attributes* attributes) {
  const Hdf5Calls& hdf5 = Hdf5();
  if (hdf5.H5Aexists(object, name) <= 0) return {};
  const Handle attribute(hdf5.H5Aopen(object, name, H5P_DEFAULT), hdf5.H5Aclose);
  if (!attribute.is_open()) return Damaged(file);
  const Handle type(hdf5.H5Aget_type(attribute.id()), hdf5.H5Tclose);
  const Handle space(hdf5.H5Aget_space(attribute.id()), hdf5.H5Sclose);
  double value = 0;
  if (!type.is_open() || !space.is_open() || KindOf(type.id()) == '?' ||
      hdf5.H5Sget_simple_extent_npoints(space.id()) != 1)
    return InputError(fmt::format(
        "{}: its attribute {} is not one number: write it as a number, or remove it", file, name));
  if (hdf5.H5Aread(attribute.id(), *hdf5.H5T_NATIVE_DOUBLE_g, &value) < 0) return Damaged(file);
  (*attributes)[name] = value;
  return {};
}

template <class T>
Result<void> ReadPixels(const OpenFile& open, int row, int column, const PixelRect& rect,
                        hid_t type, const std::string& name, StoredImage* image) {
  const Hdf5Calls& hdf5 = Hdf5();
  const ImageFileInfo& info = open.array.info;
  const auto size = [](int count) { return static_cast<hsize_t>(count); };
  Image<T>& pixels = Resized<T>(rect.width(), rect.height(), info.channels, image);
  const Handle space(hdf5.H5Dget_space(open.dataset.id()), hdf5.H5Sclose);
  const int dimensions = hdf5.H5Sget_simple_extent_ndims(space.id());
  const hsize_t begin[5] = {size(row), size(column), size(rect.y_begin), size(rect.x_begin), 0};
  const hsize_t count[5] = {1, 1, size(rect.height()), size(rect.width()), size(info.channels)};
  const hsize_t values = size(rect.height()) * size(rect.width()) * size(info.channels);
  const Handle memory(hdf5.H5Screate_simple(1, &values, nullptr), hdf5.H5Sclose);
  if (dimensions > 5 || !memory.is_open() ||
      hdf5.H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, begin, nullptr, count, nullptr) < 0 ||
      hdf5.H5Dread(open.dataset.id(), type, memory.id(), space.id(), H5P_DEFAULT,
                   pixels.pixels().data()) < 0)
    return Damaged(name);
  return {};
}

}  // namespace

Result<ViewArray> ReadHdf5Array(const fs::path& file) {
  const std::lock_guard lock(Kept().mutex);
  LF_ASSIGN_OR_RETURN(const OpenFile* open, OpenKept(file));
  return open->array;
}

Result<Hdf5Attributes> ReadHdf5Attributes(const fs::path& file) {
  const std::lock_guard lock(Kept().mutex);
  LF_ASSIGN_OR_RETURN(const OpenFile* open, OpenKept(file));
  Hdf5Attributes attributes;
  for (const char* name : {"dH", "dV", "focalLength", "shift", "camDistance", "hRes", "vRes",
                           "xRes", "yRes", "channels"})
    for (const hid_t object : {open->file.id(), open->dataset.id()})
      LF_RETURN_IF_ERROR(AddAttribute(object, name, file.string(), &attributes));
  return attributes;
}

Result<void> ReadHdf5Part(const fs::path& file, int row, int column, const WantedPixels& wanted,
                          ImagePart* part) {
  const std::lock_guard lock(Kept().mutex);
  LF_ASSIGN_OR_RETURN(const OpenFile* open, OpenKept(file));
  const std::string name = file.string();
  LF_ASSIGN_OR_RETURN(const PixelRect rect,
                      BeginArrayPart(open->array, row, column, name, wanted, part));
  const Hdf5Calls& hdf5 = Hdf5();
  if (open->array.value_bytes == 1)
    return ReadPixels<uint8_t>(*open, row, column, rect, *hdf5.H5T_NATIVE_UINT8_g, name,
                               &part->image);
  if (open->array.value_bytes == 2)
    return ReadPixels<uint16_t>(*open, row, column, rect, *hdf5.H5T_NATIVE_UINT16_g, name,
                                &part->image);
  return ReadPixels<float>(*open, row, column, rect, *hdf5.H5T_NATIVE_FLOAT_g, name, &part->image);
}

void CloseHdf5File() {
  const std::lock_guard lock(Kept().mutex);
  Kept().open.reset();
}

}  // namespace lf

#else

namespace lf {
namespace {

Error WithoutLibrary(const std::filesystem::path& file) {
  return InputError(
      fmt::format("{}: HDF5 files need a build with libhdf5: install it and build the programs "
                  "again, or save the array as a file of NumPy where h5py is: {}",
                  file.string(), SaveCommand(file)));
}

}  // namespace

Result<ViewArray> ReadHdf5Array(const std::filesystem::path& file) { return WithoutLibrary(file); }
Result<Hdf5Attributes> ReadHdf5Attributes(const std::filesystem::path& file) {
  return WithoutLibrary(file);
}
Result<void> ReadHdf5Part(const std::filesystem::path& file, int, int, const WantedPixels&,
                          ImagePart*) {
  return WithoutLibrary(file);
}
void CloseHdf5File() {}

}  // namespace lf

#endif
