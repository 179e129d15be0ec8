// SPDX-License-Identifier: Apache-2.0
#include "lf/core/shell_word.h"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace lf {

std::string ShellWord(const std::string& word) {
  const auto is_plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || std::strchr("_-./=,:+@%", c);
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string quoted = "'";
  for (const char c : word) {
    if (c == '\'')
      quoted += "'\\''";
    else
      quoted += c;
  }
  quoted += '\'';
  return quoted;
}

std::string FileArgument(const std::filesystem::path& file) {
  const std::string name = file.string();
  return name.starts_with('-') || name.starts_with('[') ? "./" + name : name;
}

std::string ShellCommand(std::span<const std::string> words) {
  std::string command;
  for (const std::string& word : words) command += (command.empty() ? "" : " ") + ShellWord(word);
  return command;
}

}  // namespace lf
