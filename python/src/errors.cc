// SPDX-License-Identifier: Apache-2.0
#include "python/src/errors.h"

#include <new>

#include "lf/core/spelling.h"

namespace lf::python {
namespace {

namespace py = pybind11;

const char* ExceptionOf(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kUsage:
      return "UsageError";
    case ErrorKind::kInput:
      return "InputError";
    case ErrorKind::kOutput:
      return "OutputError";
    case ErrorKind::kInterrupted:
      return "InterruptedRender";
    case ErrorKind::kBelowRequired:
      return "BelowRequired";
  }
  return "Error";
}

void Raise(const Error& error) {
  const py::object type = py::module_::import("lfrendertools.errors").attr(ExceptionOf(error.kind));
  PyErr_SetObject(type.ptr(), TextOf(Spelled(error.message)).ptr());
}

}  // namespace

py::str TextOf(const std::string& text) {
  PyObject* const decoded =
      PyUnicode_DecodeFSDefaultAndSize(text.data(), static_cast<py::ssize_t>(text.size()));
  if (decoded == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

void TranslateFailures() {
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const Failure& failure) {
      Raise(failure.error());
    } catch (const std::bad_alloc&) {
      Raise(OutputError("the memory of the machine does not suffice"));
    }
  });
}

}  // namespace lf::python
