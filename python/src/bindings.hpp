#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <utility>

namespace prowl::python {

// One per subject, in order of their dependence on types.
void bind_errors(nanobind::module_& module);
void bind_files(nanobind::module_& module);
void bind_robot(nanobind::module_& module);
void bind_terms(nanobind::module_& module);
void bind_task(nanobind::module_& module);
void bind_job(nanobind::module_& module);
void bind_certificate(nanobind::module_& module);
void bind_motion(nanobind::module_& module);
void bind_tracker(nanobind::module_& module);
void bind_plan(nanobind::module_& module);
void bind_tube(nanobind::module_& module);
void bind_simulation(nanobind::module_& module);
void bind_sweep(nanobind::module_& module);
void bind_planner(nanobind::module_& module);
void bind_watcher(nanobind::module_& module);
void bind_online(nanobind::module_& module);
void bind_page(nanobind::module_& module);
void bind_solve(nanobind::module_& module);
void bind_diagnosis(nanobind::module_& module);
void bind_dynamics(nanobind::module_& module);
void bind_program(nanobind::module_& module);

/// A Python object that C++ may copy and destroy without the GIL.
template <class Object>
std::shared_ptr<Object> keep(Object object) {
  return {new Object(std::move(object)), [](Object* kept) {
            const nanobind::gil_scoped_acquire python;
            delete kept;
          }};
}

}  // namespace prowl::python
