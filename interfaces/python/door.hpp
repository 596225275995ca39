#pragma once
#include <nanobind/nanobind.h>

/// What the parts of the Python door share.
namespace clutchwork::door {

/// Let Python handle signals, such as Ctrl-C, then call a function of its; whether either raised, which is kept.
template <class Call>
bool heard(nanobind::object& raised, Call&& call) {
  try {
    if (PyErr_CheckSignals() != 0) throw nanobind::python_error();
    call();
    return false;
  } catch (nanobind::python_error& error) {
    if (raised.is_none()) raised = nanobind::borrow(error.value());
    return true;
  }
}

}  // namespace clutchwork::door

void bind_sweep(nanobind::module_& m);
