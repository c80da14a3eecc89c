#include "prowl/files/visual_mesh.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

using testing::HasSubstr;

/// A triangle in a Collada file; its first corner is at (1, 2, 3) of the file's unit.
std::string collada(const std::string& up, double metres) {
  return fmt::format(
      R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="u" meter="{}"/><up_axis>{}</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="9">1 2 3 5 0 0 0 7 0</float_array><technique_common><accessor source="#pa" count="3" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><translate>0 0 10</translate><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)",
      metres, up);
}

/// A ball of radius 1 as a Wavefront file: `rings` times twice as many corners.
std::string ball(int rings) {
  std::string text;
  const int around = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < around; ++j) {
      const double a = std::numbers::pi * i / rings, b = 2 * std::numbers::pi * j / around;
      text += fmt::format("v {} {} {}\n", std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < around; ++j) {
      const int a = 1 + i * around + j, b = 1 + i * around + (j + 1) % around;
      text += fmt::format("f {} {} {}\nf {} {} {}\n", a, a + around, b, b, a + around, b + around);
    }
  }
  return text;
}

class VisualMeshFile : public testing::Test {
 protected:
  std::string refusal(const std::string& name, const std::string& text) {
    const auto file = folder_.write(name, text);
    return test::message_of(folder_.path(), [&] { read_visual_mesh(file); });
  }
  test::TempFolder folder_;
};

TEST_F(VisualMeshFile, TakesUnitAndNodesButKeepsTheAxesOfCollada) {
  for (const char* up : {"Z_UP", "Y_UP"}) {
    for (const double metres : {1.0, 0.001}) {
      const auto meshes = read_visual_mesh(folder_.write("part.dae", collada(up, metres)));
      ASSERT_EQ(meshes.size(), 1u);
      ASSERT_EQ(meshes[0].num_triangles(), 1u);
      const float* const corner = &meshes[0].positions[3 * meshes[0].triangles[0]];
      EXPECT_THAT((std::vector<float>(corner, corner + 3)),
                  testing::Pointwise(testing::FloatNear(1e-6f), {metres * 1, metres * 2, metres * 13}))
          << up;
    }
  }
}

TEST_F(VisualMeshFile, SharesCornersAndKeepsColours) {
  folder_.write("two.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
  const auto file = folder_.write(
      "two.obj", "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl red\nf 1 2 3 4\nusemtl blue\nf 4 3 2\n");
  const auto meshes = read_visual_mesh(file);
  ASSERT_EQ(meshes.size(), 2u);
  std::map<std::size_t, Eigen::Vector3d> colours;  // by number of triangles
  for (const VisualMesh& mesh : meshes) colours[mesh.num_triangles()] = mesh.colour.value();
  EXPECT_EQ(colours.at(2), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(colours.at(1), Eigen::Vector3d(0, 0, 1));
  for (const VisualMesh& mesh : meshes) EXPECT_LE(mesh.num_vertices(), 4u);
}

TEST_F(VisualMeshFile, ReducesABallToOneOfNearlyTheSameShape) {
  auto meshes = read_visual_mesh(folder_.write("ball.obj", ball(60)));
  ASSERT_EQ(meshes.size(), 1u);
  VisualMesh& mesh = meshes[0];
  const std::size_t before = mesh.num_triangles();
  simplify(mesh, 0.1);
  EXPECT_LE(mesh.num_triangles(), before / 10);
  EXPECT_GT(mesh.num_triangles(), before / 20);
  EXPECT_LT(mesh.num_vertices(), before / 10) << "corners that nobody uses stay";
  for (const std::uint32_t corner : mesh.triangles) ASSERT_LT(corner, mesh.num_vertices());
  double volume = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const auto corner = [&](std::size_t k) {
      return Eigen::Map<const Eigen::Vector3f>(&mesh.positions[3 * mesh.triangles[t + k]]).cast<double>().eval();
    };
    volume += corner(0).dot(corner(1).cross(corner(2))) / 6.0;
  }
  EXPECT_NEAR(volume, 4.0 / 3.0 * std::numbers::pi, 0.03 * volume);  // turned right way round, too
}

TEST_F(VisualMeshFile, LeavesAMeshAloneThatIsSmallEnough) {
  auto meshes = read_visual_mesh(folder_.write("ball.obj", ball(8)));
  const auto before = meshes[0].triangles;
  simplify(meshes[0], 1.0);
  EXPECT_EQ(meshes[0].triangles, before);
}

TEST_F(VisualMeshFile, RefusesWhatIsNoMesh) {
  EXPECT_THAT(refusal("part.txt", "v 0 0 0"), HasSubstr("part.txt: this kind of mesh is not supported"));
  EXPECT_THAT(refusal("part.dae", "<COLLADA"), HasSubstr("part.dae: Assimp cannot read it"));
  EXPECT_THAT(refusal("part.obj", "v 0 0 0\n"), HasSubstr("part.obj: "));
  EXPECT_THAT(refusal("part.stl",
                      "solid a\nfacet normal 0 0 1\nouter loop\nvertex nan 0 0\nvertex 1 0 0\nvertex 0 1 "
                      "0\nendloop\nendfacet\nendsolid a\n"),
              HasSubstr("part.stl: "));
  EXPECT_THAT(test::message_of(folder_.path(), [&] { read_visual_mesh(folder_.path() / "none.stl"); }),
              HasSubstr("none.stl: cannot be read"));
}

}  // namespace
}  // namespace prowl
