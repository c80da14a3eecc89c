// Stands in for libsnopt7 in the tests of SnoptSolver: the functions of snopt-interface with their published arguments,
// which check what they are handed. It solves nothing: it says of the start whether it is feasible, after comparing all
// derivatives with differences.
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

namespace {

bool initialised = false;
std::string options;

constexpr int kOptimal = 1, kInfeasible = 13, kMajorLimit = 32, kWrongDerivatives = 52, kUndefined = 63, kStopped = 71,
              kNoSpace = 82, kBadInput = 91;
constexpr int kIntegersNeeded = 700, kRealsNeeded = 900, kMajorIterations = 421;  // iw(422)

bool within(double value, double lower, double upper) { return value >= lower - 1e-6 && value <= upper + 1e-6; }

}  // namespace

extern "C" {

using Function = void(int*, int*, double[], int*, int*, double[], int*, int*, double[], char[], int*, int[], int*,
                      double[], int*);

void f_sninitx(const char* print_file, int plen, const char* summary_file, int slen, int iw[], int leniw, double rw[],
               int lenrw) {
  initialised = leniw >= 500 && lenrw >= 500 &&
                std::string(print_file, static_cast<std::size_t>(plen)) == "/dev/null" &&
                std::string(summary_file, static_cast<std::size_t>(slen)) == "/dev/null";
  options.clear();
  std::memset(iw, 0, sizeof(int) * 500);
  std::memset(rw, 0, sizeof(double) * 500);
}

void f_snset(const char* option, int length, int* errors, int[], int, double[], int) {
  const std::string text(option, static_cast<std::size_t>(length));
  *errors = text.size() > 72 ? 1 : 0;  // SNOPT's longest line
  options += text + "\n";
}

void f_snmema(int* info, int, int, int, int, int* miniw, int* minrw, int[], int, double[], int) {
  *info = 104;
  *miniw = kIntegersNeeded;
  *minrw = kRealsNeeded;
}

void f_snend(int[], int, double[], int) { initialised = false; }

void f_snopta(int start, const char*, int nf, int n, double objadd, int objrow, Function* function, int[], int[],
              int neA, double[], int iGfun[], int jGvar[], int neG, double xlow[], double xupp[], double flow[],
              double fupp[], double x[], int xstate[], double xmul[], double f[], int fstate[], double fmul[],
              int* inform, int*, int*, double*, int*, int*, int iu[], int leniu, double ru[], int lenru, int iw[],
              int leniw, double[], int lenrw) {
  *inform = kBadInput;
  if (!initialised || start != 0 || objadd != 0.0 || objrow != 1 || neA != 0) return;
  for (int i = 0; i < n; ++i) {
    if (xstate[i] != 0 || xmul[i] != 0.0 || std::abs(xlow[i]) > 1e20 || std::abs(xupp[i]) > 1e20) return;
  }
  for (int i = 0; i < nf; ++i) {
    if (fstate[i] != 0 || fmul[i] != 0.0 || std::abs(flow[i]) > 1e20 || std::abs(fupp[i]) > 1e20) return;
  }
  for (int k = 0; k < neG; ++k) {
    if (iGfun[k] < 1 || iGfun[k] > nf || jGvar[k] < 1 || jGvar[k] > n) return;
  }
  *inform = kNoSpace;
  if (leniw < kIntegersNeeded || lenrw < kRealsNeeded) return;
  if (options.find("Total integer workspace " + std::to_string(leniw) + "\n") == std::string::npos) return;

  std::vector<double> g(static_cast<std::size_t>(neG)),
      dense(static_cast<std::size_t>(n) * static_cast<std::size_t>(nf), 0.0);
  char cu[8] = "";
  int lencu = 1;
  const auto evaluate = [&](double at[], double values[], double derivatives[]) {
    int status = 0, yes = values ? 1 : 0, and_those = derivatives ? 1 : 0;
    function(&status, &n, at, &yes, &nf, values, &and_those, &neG, derivatives, cu, &lencu, iu, &leniu, ru, &lenru);
    return status;
  };
  const int status = evaluate(x, f, g.data());
  if (status < 0) {
    *inform = status == -1 ? kUndefined : kStopped;
    return;
  }
  for (int k = 0; k < neG; ++k) dense[(iGfun[k] - 1) * n + jGvar[k] - 1] += g[k];
  std::vector<double> point(x, x + n), above(static_cast<std::size_t>(nf)), below(above);
  for (int j = 0; j < n; ++j) {
    constexpr double kStep = 1e-6;
    point[j] = x[j] + kStep;
    evaluate(point.data(), above.data(), nullptr);
    point[j] = x[j] - kStep;
    evaluate(point.data(), below.data(), nullptr);
    point[j] = x[j];
    for (int i = 0; i < nf; ++i) {
      const auto row = static_cast<std::size_t>(i);
      const double slope = (above[row] - below[row]) / (2.0 * kStep);
      *inform = kWrongDerivatives;
      if (std::abs(slope - dense[i * n + j]) > 1e-5 * std::max(1.0, std::abs(slope))) return;
    }
  }
  iw[kMajorIterations] = 7;
  bool feasible = true;
  for (int j = 0; j < n; ++j) feasible = feasible && within(x[j], xlow[j], xupp[j]);
  for (int i = 0; i < nf; ++i) feasible = feasible && within(f[i], flow[i], fupp[i]);
  // The multipliers of Hock and Schittkowski's problem 71, as SNOPT has them: of f − π . g.
  if (nf == 3) fmul[1] = 0.55229366, fmul[2] = -0.16146857;
  *inform = feasible ? kOptimal : kInfeasible;
  if (options.find("Major iterations limit 1\n") != std::string::npos) *inform = kMajorLimit;
}

}  // extern "C"
