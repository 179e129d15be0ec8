// SPDX-License-Identifier: Apache-2.0
// Errors as values: bad input and failing machines (doc/style.md, "Errors"). LF_CHECK catches our
// own bugs. Nothing in the library throws, except std::bad_alloc if memory runs out.
//
//   const lf::Result<lf::LightField> light_field = lf::Open("capture");
//   if (!light_field) return lf::Report(light_field.error());
//   std::printf("%zu LF images\n", light_field->size());
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "lf/core/check.h"

namespace lf {

// The kind of an error. Its value is the exit code that a program ends with. The table of exit
// codes in doc/design.md is made of these comments. Two exit codes are not kinds of an error:
//   0  done
//   1  internal error: a bug of the program (please report the last lines of stderr)
enum class ErrorKind {
  // Wrong usage: an option or argument of the call, or options that contradict each other.
  kUsage = 2,
  // Bad input: a file, or a value in it.
  kInput = 3,
  // The machine failed: disk or memory does not suffice, or a program that we call failed.
  kOutput = 4,
  // Interrupted; the work done is kept, and the same call continues it if told to resume.
  kInterrupted = 5,
  // Finished, but below what was asked for: more LF images were left out, because they are missing
  // or broken, than the call accepts, frames have less than it requires, or no element of a depth
  // map has a depth. Everything is written; the last line has the count.
  kBelowRequired = 6,
};

// The message names file, line or entry, the value found, what was expected and what to do. It
// names options by their keys, such as {max_images}; Report() (api/film.h) prints it without
// the braces.
struct Error {
  ErrorKind kind = ErrorKind::kInput;
  std::string message;
};

inline Error UsageError(std::string message) { return {ErrorKind::kUsage, std::move(message)}; }
inline Error InputError(std::string message) { return {ErrorKind::kInput, std::move(message)}; }
inline Error OutputError(std::string message) { return {ErrorKind::kOutput, std::move(message)}; }

// A value or the error that prevented it. Shaped like std::expected (C++23).
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}      // NOLINT: implicit on purpose
  Result(Error error) : state_(std::move(error)) {}  // NOLINT

  bool has_value() const { return state_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  const T& value() const& {
    LF_CHECK(has_value());
    return std::get<0>(state_);
  }
  T& value() & {
    LF_CHECK(has_value());
    return std::get<0>(state_);
  }
  T&& value() && {
    LF_CHECK(has_value());
    return std::get<0>(std::move(state_));
  }
  const T& operator*() const& { return value(); }
  T& operator*() & { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  const T* operator->() const { return &value(); }
  T* operator->() { return &value(); }

  const Error& error() const {
    LF_CHECK(!has_value());
    return std::get<1>(state_);
  }

 private:
  std::variant<T, Error> state_;
};

template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}  // NOLINT
  bool has_value() const { return !error_; }
  explicit operator bool() const { return has_value(); }
  const Error& error() const {
    LF_CHECK(error_.has_value());
    return *error_;
  }

 private:
  std::optional<Error> error_;
};

// Returns from the calling function with the error of the Result `expression`, if it has an error.
#define LF_RETURN_IF_ERROR(expression)                                         \
  do {                                                                         \
    if (auto&& lf_result = (expression); !lf_result) return lf_result.error(); \
  } while (false)

// Initializes a variable with the value of a Result. If the Result has an error, returns from the
// calling function with the error:
//   LF_ASSIGN_OR_RETURN(auto image, ReadImage(path));
#define LF_ASSIGN_OR_RETURN(declaration, expression) \
  LF_ASSIGN_OR_RETURN_(LF_CONCAT_(lf_result_, __LINE__), declaration, expression)
#define LF_ASSIGN_OR_RETURN_(result, declaration, expression) \
  auto result = (expression);                                 \
  if (!result) return result.error();                         \
  declaration = *std::move(result)
#define LF_CONCAT_(a, b) LF_CONCAT_2_(a, b)
#define LF_CONCAT_2_(a, b) a##b

}  // namespace lf
