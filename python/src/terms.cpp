#include "terms.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <mutex>
#include <optional>
#include <set>

#include "prowl/error.hpp"
#include "prowl/text/nearest_name.hpp"

namespace prowl::python {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using TermArray = nb::ndarray<double, nb::f_contig, nb::device::cpu>;

/// A Python function with fixed arrays for arguments and result, which a call without arguments fills.
struct Evaluator {
  nb::object call;
  std::vector<TermArray> arguments;
  TermArray result;
};

Evaluator evaluator(const nb::handle& parts) {
  const auto all = nb::cast<nb::sequence>(parts);
  Evaluator made{nb::borrow(all[0]), {}, nb::cast<TermArray>(all[2])};
  for (nb::handle argument : nb::cast<nb::sequence>(all[1])) made.arguments.push_back(nb::cast<TermArray>(argument));
  return made;
}

/// The lock of the interpreter together with one of our own, as CasADi gives up the former within a call. Never waits
/// for ours with the interpreter's.
class BothLocks {
 public:
  explicit BothLocks(std::recursive_mutex& mutex) : own_(mutex, std::defer_lock) {
    if (PyGILState_Check() != 0) {
      const nb::gil_scoped_release others_may_run;
      own_.lock();
    } else {
      own_.lock();
    }
    interpreter_.emplace();
  }

 private:
  std::unique_lock<std::recursive_mutex> own_;
  std::optional<nb::gil_scoped_acquire> interpreter_;
};

/// A term in Python. One thread at a time runs its functions, which share their arrays.
class PythonTerm : public Term {
 public:
  PythonTerm(std::vector<Quantity> reads, std::vector<std::string> rows, std::string unit, double size, Evaluator value,
             Evaluator jacobian, Evaluator hessian)
      : Term(std::move(reads), std::move(rows), std::move(unit), size),
        functions_(new Functions{std::move(value), std::move(jacobian), std::move(hessian)}) {
    all().insert(this);
  }
  ~PythonTerm() override {
    if (!nb::is_alive()) return;  // after the end of the interpreter, which has called release_all()
    const nb::gil_scoped_acquire lock;
    all().erase(this);
    functions_.reset();
  }
  PythonTerm(const PythonTerm&) = delete;
  PythonTerm& operator=(const PythonTerm&) = delete;

  /// At the end of the interpreter. Its collector does not see that a term refers to its functions, which refer to all
  /// names of their module, perhaps to the term.
  static void release_all() {
    for (PythonTerm* term : all()) {
      const std::unique_lock<std::recursive_mutex> own(term->mutex_, std::try_to_lock);
      if (own) term->functions_.reset();  // otherwise a thread that outlives the interpreter is inside
    }
  }

  void value(const VectorXd& y, Eigen::Ref<VectorXd> f) const override {
    const BothLocks lock(mutex_);
    call(functions().value, {&y});
    f = Eigen::Map<const VectorXd>(functions_->value.result.data(), f.size());
  }
  void jacobian(const VectorXd& y, Eigen::Ref<MatrixXd> f_y) const override {
    const BothLocks lock(mutex_);
    call(functions().jacobian, {&y});
    f_y = Eigen::Map<const MatrixXd>(functions_->jacobian.result.data(), f_y.rows(), f_y.cols());
  }
  void hessian(const VectorXd& y, const VectorXd& multipliers, Eigen::Ref<MatrixXd> f_yy) const override {
    const BothLocks lock(mutex_);
    call(functions().hessian, {&y, &multipliers});
    f_yy = Eigen::Map<const MatrixXd>(functions_->hessian.result.data(), f_yy.rows(), f_yy.cols());
  }

 private:
  struct Functions {
    Evaluator value, jacobian, hessian;
  };

  const Functions& functions() const {
    if (!functions_) throw Error("own_term: Python has ended");
    return *functions_;
  }

  /// Guarded by the lock of the interpreter.
  static std::set<PythonTerm*>& all() {
    static std::set<PythonTerm*> terms;
    return terms;
  }

  static void call(const Evaluator& function, std::initializer_list<const VectorXd*> arguments) {
    auto array = function.arguments.begin();
    for (const VectorXd* argument : arguments) {
      if (static_cast<std::size_t>(argument->size()) != array->size()) {
        throw InputError(fmt::format("own_term: the quantities have {} entries, and the function {}", argument->size(),
                                     array->size()));
      }
      std::copy(argument->begin(), argument->end(), array->data());
      ++array;
    }
    function.call();
  }

  std::unique_ptr<Functions> functions_;
  mutable std::recursive_mutex mutex_;
};

Quantity quantity(const std::pair<std::string, std::string>& read) {
  const std::vector<std::string> kinds(std::begin(kQuantityNames), std::end(kQuantityNames));
  const auto found = std::ranges::find(kinds, read.first);
  if (found != kinds.end()) {
    return {.kind = static_cast<Quantity::Kind>(found - kinds.begin()), .name = read.second};
  }
  throw InputError(fmt::format("reads: \"{}\" is not allowed{} Known: {}", read.first, did_you_mean(read.first, kinds),
                               fmt::join(kinds, ", ")));
}

TermObject make_term(const std::vector<std::pair<std::string, std::string>>& reads, std::vector<std::string> rows,
                     std::string unit, double size, const nb::handle& value, const nb::handle& jacobian,
                     const nb::handle& hessian) {
  std::vector<Quantity> quantities;
  for (const auto& read : reads) quantities.push_back(quantity(read));
  return {std::make_shared<PythonTerm>(std::move(quantities), std::move(rows), std::move(unit), size, evaluator(value),
                                       evaluator(jacobian), evaluator(hessian))};
}

}  // namespace

OwnTerms own_terms(const std::map<std::string, TermObject>& known, bool allow_libraries) {
  OwnTerms result{.allows_libraries = allow_libraries};
  for (const auto& [name, object] : known) result.known[name] = object.term;
  return result;
}

void bind_terms(nb::module_& module) {
  nb::module_::import_("atexit").attr("register")(nb::cpp_function([] { PythonTerm::release_all(); }));
  nb::class_<TermObject>(module, "Term",
                         "A function of what the robot does at one moment, for costs and limits: prowl.own_term() "
                         "makes one.")
      .def_prop_ro(
          "rows", [](const TermObject& object) { return object.term->rows(); }, "Names of the entries of its value.")
      .def_prop_ro(
          "unit", [](const TermObject& object) { return object.term->unit(); }, "Of all entries; \"-\" if none.")
      .def("__repr__", [](const TermObject& object) {
        return fmt::format("<prowl.Term {} [{}]>", fmt::join(object.term->rows(), ", "), object.term->unit());
      });
  module.def(
      "quantity_names", [] { return std::vector<std::string>(std::begin(kQuantityNames), std::end(kQuantityNames)); },
      "Kinds of quantities that a term may read.");
  module.def(
      "make_term", &make_term, nb::arg("reads"), nb::arg("rows"), nb::arg("unit"), nb::arg("size"), nb::arg("value"),
      nb::arg("jacobian"), nb::arg("hessian"),
      nb::sig("def make_term(reads: collections.abc.Sequence[tuple[str, str]], rows: "
              "collections.abc.Sequence[str], unit: str, size: float, value: tuple[collections.abc.Callable[[], "
              "object], list[numpy.ndarray], numpy.ndarray], jacobian: tuple[collections.abc.Callable[[], object], "
              "list[numpy.ndarray], numpy.ndarray], hessian: tuple[collections.abc.Callable[[], object], "
              "list[numpy.ndarray], numpy.ndarray]) -> Term"),
      "prowl.own_term with functions that fill arrays: each is (call, arguments, result).");
}

}  // namespace prowl::python
