// SPDX-License-Identifier: Apache-2.0
#include "lf/core/process_identity.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <sstream>
#include <vector>

namespace lf {
namespace {

// Facts of a process from /proc/PROCESS/stat.
struct ProcessFacts {
  char state = 'R';
  uint64_t start = 0;
};

std::optional<ProcessFacts> FactsOf(pid_t process) {
  std::ifstream file(fmt::format("/proc/{}/stat", process));
  std::string line;
  if (!std::getline(file, line)) return std::nullopt;
  // The name of the program stands in parentheses, and may contain spaces and parentheses.
  const size_t end = line.rfind(')');
  if (end == std::string::npos) return std::nullopt;
  std::istringstream fields(line.substr(end + 1));
  ProcessFacts facts;
  constexpr int kFieldsBetween = 18;  // fields 4 to 21 lie between the state and the start
  fields >> facts.state;
  std::string skipped;
  for (int i = 0; i < kFieldsBetween; ++i) fields >> skipped;
  if (!(fields >> facts.start)) return std::nullopt;
  return facts;
}

std::string OneWord(std::string text) {
  for (char& letter : text)
    if (static_cast<unsigned char>(letter) <= ' ') letter = '_';
  return text;
}

std::string SystemName() {
  std::ifstream file("/proc/sys/kernel/random/boot_id");
  std::string boot;
  struct stat processes {};
  if (!std::getline(file, boot) || ::stat("/proc/self/ns/pid", &processes) != 0) return "";
  return OneWord(fmt::format("{}/{}", boot, processes.st_ino));
}

const std::string& System() {
  static const std::string system = SystemName();
  return system;
}

template <class Number>
bool Parse(std::string_view text, Number* number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *number);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

ProcessIdentity IdentityOf(pid_t process) {
  std::array<char, 256> name{};
  ProcessIdentity identity;
  identity.process = process;
  identity.system = System();
  identity.host = ::gethostname(name.data(), name.size() - 1) == 0 ? OneWord(name.data()) : "";
  if (const auto facts = FactsOf(process)) identity.start = facts->start;
  return identity;
}

std::string TextOf(const ProcessIdentity& identity) {
  const auto word = [](const std::string& text) { return text.empty() ? "-" : text.c_str(); };
  return fmt::format("{} {} {} {}", identity.process, identity.start, word(identity.system),
                     word(identity.host));
}

std::optional<ProcessIdentity> ReadIdentity(std::string_view line) {
  std::istringstream fields{std::string(line)};
  std::vector<std::string> words;
  for (std::string word; fields >> word;) words.push_back(word == "-" ? "" : word);
  ProcessIdentity identity;
  if (words.size() != 4 || !Parse(words[0], &identity.process) || identity.process <= 0 ||
      !Parse(words[1], &identity.start))
    return std::nullopt;
  identity.system = words[2];
  identity.host = words[3];
  return identity;
}

ProcessLife LifeOf(const ProcessIdentity& identity) {
  if (identity.system.empty() || identity.system != System()) return ProcessLife::kUnknown;
  if (::kill(identity.process, 0) != 0 && errno == ESRCH) return ProcessLife::kEnded;
  // /proc may hide the processes of other users: they then count as living.
  const auto facts = FactsOf(identity.process);
  if (!facts) return ProcessLife::kLives;
  const bool is_another =
      identity.start != 0 && facts->start != 0 && identity.start != facts->start;
  const bool has_ended = facts->state == 'Z' || facts->state == 'X';
  return is_another || has_ended ? ProcessLife::kEnded : ProcessLife::kLives;
}

}  // namespace lf
