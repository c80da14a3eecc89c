#include "prowl/files/visual_mesh.hpp"

#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>

#include "prowl/error.hpp"

namespace prowl {
namespace {

constexpr std::uintmax_t kLargestFile = 256u << 20;  // [bytes]; the largest known are below 40 MB
constexpr std::array kKinds = {".dae", ".stl", ".obj", ".ply", ".glb"};
constexpr std::size_t kVertexBytes = 3 * sizeof(float);

void check_file(const std::filesystem::path& file) {
  std::string kind = file.extension().string();
  std::transform(kind.begin(), kind.end(), kind.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (std::find(kKinds.begin(), kKinds.end(), kind) == kKinds.end()) {
    throw InputError(
        fmt::format("{}: this kind of mesh is not supported; need .dae, .stl, .obj, .ply or .glb", file.string()));
  }
  std::error_code error;
  if (std::filesystem::file_size(file, error) > kLargestFile || error) {
    throw InputError(fmt::format("{}: cannot be read, or larger than {} bytes", file.string(), kLargestFile));
  }
}

VisualMesh to_mesh(const aiMesh& source, const aiScene& scene) {
  VisualMesh mesh;
  mesh.positions.reserve(3 * source.mNumVertices);
  for (unsigned i = 0; i < source.mNumVertices; ++i) {
    const aiVector3D& p = source.mVertices[i];
    mesh.positions.insert(mesh.positions.end(), {p.x, p.y, p.z});
  }
  for (unsigned i = 0; i < source.mNumFaces; ++i) {
    const aiFace& face = source.mFaces[i];
    if (face.mNumIndices == 3) mesh.triangles.insert(mesh.triangles.end(), face.mIndices, face.mIndices + 3);
  }
  aiColor4D colour;
  if (source.mMaterialIndex < scene.mNumMaterials &&
      scene.mMaterials[source.mMaterialIndex]->Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS) {
    mesh.colour = Eigen::Vector3d(colour.r, colour.g, colour.b).cwiseMax(0.0).cwiseMin(1.0);
  }
  return mesh;
}

bool is_finite(const VisualMesh& mesh) {
  return std::all_of(mesh.positions.begin(), mesh.positions.end(), [](float x) { return std::isfinite(x); });
}

}  // namespace

std::vector<VisualMesh> read_visual_mesh(const std::filesystem::path& file) {
  check_file(file);
  Assimp::Importer importer;
  // URDF uses the file's own axes, Z up or not.
  importer.SetPropertyInteger(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, 1);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  // Vertices that differ only in these become one; the reader of the mesh computes normals again.
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS,
                              aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_COLORS |
                                  aiComponent_TEXCOORDS | aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                  aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS);
  const aiScene* const scene = importer.ReadFile(
      file.string(), aiProcess_Triangulate | aiProcess_RemoveComponent | aiProcess_PreTransformVertices |
                         aiProcess_JoinIdenticalVertices | aiProcess_SortByPType);
  if (scene == nullptr)
    throw InputError(fmt::format("{}: Assimp cannot read it: {}", file.string(), importer.GetErrorString()));
  std::vector<VisualMesh> meshes;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    VisualMesh mesh = to_mesh(*scene->mMeshes[i], *scene);
    if (!is_finite(mesh)) throw InputError(fmt::format("{}: contains vertices that are not finite", file.string()));
    if (mesh.num_triangles() > 0) meshes.push_back(std::move(mesh));
  }
  if (meshes.empty()) throw InputError(fmt::format("{}: contains no triangles", file.string()));
  return meshes;
}

void simplify(VisualMesh& mesh, double share) {
  if (share >= 1.0 || mesh.triangles.empty()) return;
  constexpr float kAnyError = 1.0f;  // relative to the size of the mesh: only the number of triangles counts
  const std::size_t target =
      3 * std::max<std::size_t>(4, static_cast<std::size_t>(share * static_cast<double>(mesh.num_triangles())));
  std::vector<std::uint32_t> fewer(mesh.triangles.size());
  std::size_t count = meshopt_simplify(fewer.data(), mesh.triangles.data(), mesh.triangles.size(),
                                       mesh.positions.data(), mesh.num_vertices(), kVertexBytes, target, kAnyError);
  if (count > 2 * target) {  // many small pieces: give up their shape
    count = meshopt_simplifySloppy(fewer.data(), mesh.triangles.data(), mesh.triangles.size(), mesh.positions.data(),
                                   mesh.num_vertices(), kVertexBytes, target, kAnyError);
  }
  if (count == 0) return;
  fewer.resize(count);
  std::vector<float> positions(mesh.positions.size());
  const std::size_t vertices = meshopt_optimizeVertexFetch(positions.data(), fewer.data(), count, mesh.positions.data(),
                                                           mesh.num_vertices(), kVertexBytes);
  positions.resize(3 * vertices);
  mesh.positions = std::move(positions);
  mesh.triangles = std::move(fewer);
}

}  // namespace prowl
