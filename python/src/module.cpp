#include <nanobind/nanobind.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>

#include "bindings.hpp"
#include "prowl/session/environment.hpp"

NB_MODULE(_prowl, module) {
  using namespace prowl::python;
  module.doc() = "Bindings of Prowl's library; use the package prowl.";
  bind_errors(module);
  bind_files(module);
  bind_robot(module);
  bind_terms(module);
  bind_task(module);
  bind_job(module);
  bind_certificate(module);
  bind_motion(module);
  bind_tracker(module);
  bind_plan(module);
  bind_tube(module);
  bind_simulation(module);
  bind_sweep(module);
  bind_planner(module);
  bind_watcher(module);
  bind_online(module);
  bind_page(module);
  bind_solve(module);
  bind_diagnosis(module);
  bind_dynamics(module);
  bind_program(module);
  module.def("versions", &prowl::all_versions, "Versions of Prowl and its libraries.");
  module.attr("__version__") = PROWL_VERSION;
}
