#include "prowl/certificate/certificate.hpp"

#include <fmt/format.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"
#include "package_function.hpp"
#include "screen/plan_summary.hpp"

namespace prowl::python {

namespace nb = nanobind;

void bind_certificate(nb::module_& module) {
  nb::class_<CertificateCheck>(module, "Check", "A check of the certificate at its worst moment.")
      .def_ro("name", &CertificateCheck::name, "\"contact drift\", \"friction cone\", \"joint torque\", ...")
      .def_ro("worst", &CertificateCheck::worst, "Largest value, in `unit`; negative values are remaining margin.")
      .def_ro("limit", &CertificateCheck::limit, "The check passes if worst <= limit.")
      .def_ro("certified_limit", &CertificateCheck::certified_limit, "Limit of grade \"certified\".")
      .def_ro("unit", &CertificateCheck::unit)
      .def_ro("time", &CertificateCheck::time, "Time of the worst value [s].")
      .def_ro("where", &CertificateCheck::where, "Contact, joint or coordinate; \"\" if none.")
      .def_ro("passed", &CertificateCheck::passed)
      .def("__repr__", [](const CertificateCheck& check) {
        return fmt::format("<prowl.Check {}: {:.3g}, limit {:.3g} {}, {}>", check.name, check.worst, check.limit,
                           check.unit, check.passed ? "passed" : "FAILED");
      });
  nb::class_<Certificate>(
      module, "Certificate",
      "Checks of a finished motion by code that shares neither dynamics nor transcription with the planner\n"
      "(docs/verification.md). print() and notebooks show it as a table.")
      .def_ro("passed", &Certificate::passed)
      .def_prop_ro(
          "grade", [](const Certificate& certificate) { return to_string(certificate.grade); },
          "\"failed\", \"draft\" or \"certified\".")
      .def_ro("checks", &Certificate::checks, nb::rv_policy::reference_internal)
      .def_ro("redundant_contacts", &Certificate::redundant_contacts,
              "Contacts whose forces are one choice of many; those of all others follow from the motion.")
      .def("__str__", [](const Certificate& c) { return certificate_summary(c); })
      .def(
          "_repr_html_", [](nb::handle self) { return call_package("prowl._show.notebook", "certificate_html", self); },
          nb::sig("def _repr_html_(self) -> str"))
      .def("__repr__", [](const Certificate& certificate) {
        return fmt::format("<prowl.Certificate {}, {} checks>", to_string(certificate.grade),
                           certificate.checks.size());
      });
}

}  // namespace prowl::python
