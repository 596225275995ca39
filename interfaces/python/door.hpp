#pragma once
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <utility>
#include <vector>

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

/// An array of numpy over what it owns.
template <class T>
nanobind::object owned(std::vector<T>&& numbers, std::vector<std::size_t> shape) {
  auto* kept = new std::vector<T>(std::move(numbers));
  nanobind::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return nanobind::cast(nanobind::ndarray<nanobind::numpy, T>(kept->data(), shape.size(), shape.data(), owner));
}

}  // namespace clutchwork::door

void bind_sweep(nanobind::module_& m);
