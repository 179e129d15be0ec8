// SPDX-License-Identifier: Apache-2.0
// Turns errors of the library into Python's exceptions (lfrendertools/errors.py).
#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <string>
#include <utility>

#include "lf/core/result.h"

namespace lf::python {

// An error on its way to Python.
class Failure : public std::exception {
 public:
  explicit Failure(Error error) : error_(std::move(error)) {}
  const Error& error() const { return error_; }
  const char* what() const noexcept override { return error_.message.c_str(); }

 private:
  Error error_;
};

// Returns the value of a result, or throws its error.
template <class T>
T Take(Result<T> result) {
  if (!result) throw Failure(result.error());
  return *std::move(result);
}
inline void Take(const Result<void>& result) {
  if (!result) throw Failure(result.error());
}

// Returns a text for Python. Bytes of file names that are not UTF-8 become what os.fsdecode makes
// of them.
pybind11::str TextOf(const std::string& text);

// Makes the module translate each Failure into the exception of its kind, and std::bad_alloc into
// an OutputError.
void TranslateFailures();

}  // namespace lf::python
