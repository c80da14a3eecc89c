#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace prowl {

/// Triangles of one colour.
struct VisualMesh {
  std::vector<float> positions;           ///< x y z of each vertex, in the axes and the unit of the URDF [m]
  std::vector<std::uint32_t> triangles;   ///< three vertices each, counterclockwise seen from outside
  std::optional<Eigen::Vector3d> colour;  ///< red, green, blue, 0 ... 1; none if the file gives none

  std::size_t num_vertices() const { return positions.size() / 3; }
  std::size_t num_triangles() const { return triangles.size() / 3; }
};

/// The parts of a mesh file (.dae, .stl, .obj, .ply, .glb), one per material, by Assimp. Applies the transforms of
/// nodes and the unit; keeps the axes of the file, as other readers of URDF do; drops textures. Throws InputError.
std::vector<VisualMesh> read_visual_mesh(const std::filesystem::path& file);

/// Keeps about `share` (0 ... 1) of the triangles, by meshoptimizer; fewer if the mesh has many separate pieces.
void simplify(VisualMesh& mesh, double share);

}  // namespace prowl
