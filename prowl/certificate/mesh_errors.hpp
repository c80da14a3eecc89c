#pragma once

#include <vector>

#include "prowl/certificate/certificate.hpp"

namespace prowl {

/// Allowed integration errors of a motion, scaled as in the certificate [-].
struct MeshTolerance {
  double local = 0.0;          ///< local integration error of an interval
  double second = 0.0;         ///< the same, of one coordinate, summed over any second
  double reintegration = 0.0;  ///< of the state at the end of an interval
};

/// Tolerance of grade draft or certified.
MeshTolerance mesh_tolerance(CertificateGrade grade);
/// For a given re-integration error: the local error scales with it; the error in a second is that of grade certified
/// if the given error meets that grade, else of draft.
MeshTolerance mesh_tolerance(double reintegration);

/// Worst errors in the certificate.
MeshTolerance mesh_errors(const Certificate& certificate);

/// True if no check fails except those of integration errors: a finer mesh may help.
bool fails_by_mesh_only(const Certificate& certificate);

/// Error over tolerance of each mesh interval, the larger of its two: above 1 the interval is too long; infinite if an
/// error is not finite. Once every interval is short enough by itself, the sum over a second counts, too. With error c
/// per piece there are c^(-1/3) pieces, so the sum goes with c^(2/3) and c may be worst (tolerance / sum)^(3/2).
std::vector<double> error_parts(const Certificate& certificate, const MeshTolerance& tolerance);

}  // namespace prowl
