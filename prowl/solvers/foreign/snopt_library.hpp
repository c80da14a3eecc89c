#pragma once

#include <optional>
#include <string>

namespace prowl {

extern "C" {
/// Callback of SNOPT for values and derivatives; `status` -1: undefined here, -2: stop.
using SnoptFunction = void(int* status, int* n, double x[], int* need_values, int* num_rows, double values[],
                           int* need_derivatives, int* num_derivatives, double derivatives[], char cu[], int* lencu,
                           int iu[], int* leniu, double ru[], int* lenru);
}

/// The C functions of snopt-interface (github.com/snopt/snopt-interface, include/snopt.h) that
/// SnoptSolver needs, from a library loaded at run time. Initialisation functions changed with
/// versions: f_sninitx (called by SNOPT7.jl of the same authors) or else f_sninitf is used. The
/// older f_sninit had three signatures under one name, and libraries without newer functions pass
/// all arguments by address: they are not supported.
class SnoptLibrary {
 public:
  /// A path, or a name for the dynamic linker.
  explicit SnoptLibrary(const std::string& file);
  ~SnoptLibrary();
  SnoptLibrary(const SnoptLibrary&) = delete;
  SnoptLibrary& operator=(const SnoptLibrary&) = delete;

  /// Reason; nullopt if the functions below may be called.
  const std::optional<std::string>& why_unusable() const { return why_unusable_; }

  /// Work spaces iw, rw: at least 500 numbers each. No print file, no summary.
  void initialise(int iw[], int leniw, double rw[], int lenrw) const;
  void (*set)(const char* option, int length, int* errors, int iw[], int leniw, double rw[], int lenrw) = nullptr;
  void (*needed_memory)(int* info, int num_rows, int n, int num_linear, int num_derivatives, int* miniw, int* minrw,
                        int iw[], int leniw, double rw[], int lenrw) = nullptr;
  void (*solve)(int start, const char* name, int num_rows, int n, double objective_constant, int objective_row,
                SnoptFunction* function, int linear_row[], int linear_col[], int num_linear, double linear[], int row[],
                int col[], int num_derivatives, double lower[], double upper[], double row_lower[], double row_upper[],
                double x[], int x_state[], double x_multipliers[], double values[], int row_state[],
                double row_multipliers[], int* info, int* num_superbasics, int* num_infeasible, double* sum_infeasible,
                int* miniw, int* minrw, int iu[], int leniu, double ru[], int lenru, int iw[], int leniw, double rw[],
                int lenrw) = nullptr;
  void (*end)(int iw[], int leniw, double rw[], int lenrw) = nullptr;

 private:
  void* handle_ = nullptr;
  void (*initialise_with_paths_)(const char* print_file, int print_length, const char* summary_file, int summary_length,
                                 int iw[], int leniw, double rw[], int lenrw) = nullptr;
  void (*initialise_with_name_)(const char* print_file, int length, int summary_on, int iw[], int leniw, double rw[],
                                int lenrw) = nullptr;
  std::optional<std::string> why_unusable_;
};

}  // namespace prowl
