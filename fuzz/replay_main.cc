// SPDX-License-Identifier: Apache-2.0
// Runs a fuzz target over the files of its corpus folders without libFuzzer. Every test run replays
// in this way the inputs that once broke a parser.
//
// usage: x_fuzz FOLDER...      exit 1 if a folder is missing, or if the folders hold no file
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes);

int main(int argc, char** argv) {
  size_t file_count = 0;
  for (int i = 1; i < argc; ++i) {
    std::error_code error;
    std::filesystem::directory_iterator folder(argv[i], error);
    if (error) {
      std::fprintf(stderr, "%s: %s\n", argv[i], error.message().c_str());
      return 1;
    }
    for (const auto& entry : folder) {
      std::ifstream file(entry.path(), std::ios::binary);
      const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
      LLVMFuzzerTestOneInput(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
      ++file_count;
    }
  }
  std::printf("%zu inputs replayed\n", file_count);
  return file_count > 0 ? 0 : 1;
}
