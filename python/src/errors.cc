#include "python/src/errors.h"

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

}  // namespace

void TranslateFailures() {
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const Failure& failure) {
      const py::object type =
          py::module_::import("lfrendertools.errors").attr(ExceptionOf(failure.error().kind));
      PyErr_SetString(type.ptr(), failure.what());
    }
  });
}

}  // namespace lf::python
