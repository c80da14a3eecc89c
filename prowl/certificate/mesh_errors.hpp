#pragma once

#include <vector>

#include "prowl/certificate/certificate.hpp"

namespace prowl {

/// What the integration errors of a motion may be, scaled as in the certificate [-].
struct MeshTolerance {
  double local = 0.0;          ///< local integration error of an interval
  double second = 0.0;         ///< the same of one coordinate, summed over any second
  double reintegration = 0.0;  ///< of the state at the end of an interval
};

/// What grade draft or certified asks for.
MeshTolerance mesh_tolerance(Grade grade);
/// For a re-integration error of one's own: the local error in the proportion that it has to it in both grades, the
/// error in a second as in the best grade that it allows, or draft.
MeshTolerance mesh_tolerance(double reintegration);

/// The worst of a motion, as its certificate has them.
MeshTolerance mesh_errors(const Certificate& certificate);

/// Whether a finer mesh may do: no check fails but those of the integration error.
bool fails_by_mesh_only(const Certificate& certificate);

/// Of each mesh interval, the larger of its errors as a part of what it may be: none is above 1 where the mesh is fine
/// enough; infinite where an error is not finite. Once no interval is too coarse by itself the sum over a second counts
/// as well: with error c in each piece it goes with c^(2/3), for there are c^(-1/3) pieces, so that intervals may have
/// no more than c = worst (what the sum may be / what it is)^(3/2).
std::vector<double> error_parts(const Certificate& certificate, const MeshTolerance& tolerance);

}  // namespace prowl
