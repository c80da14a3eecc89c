#include "prowl/model/urdf/package_path.hpp"

#include <gtest/gtest.h>

#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

class PackagePath : public testing::Test {
 protected:
  std::filesystem::path resolve(const std::string& uri) const {
    return resolve_uri(uri, folder_.path() / "work/robots/dog.toml", {folder_.path() / "own"},
                       {.folders = {folder_.path() / "given"},
                        .working_directory = folder_.path() / "elsewhere/deep",
                        .clone = folder_.path() / "clone",
                        .installed = {folder_.path() / "installed/share"}});
  }
  test::TempFolder folder_;
};

// From the last place to the first, so that each new file has to win over all before.
TEST_F(PackagePath, SearchesInOrder) {
  const std::string uri = "package://dog/urdf/dog.urdf";
  EXPECT_THROW(resolve(uri), InputError);
  for (const char* folder :
       {"installed/share", "clone/.venv/lib/python3.10/site-packages/cmeel.prefix/share",
        "elsewhere/.venv/lib/python3.11/site-packages/cmeel.prefix/share",
        "work/.venv/lib/python3.12/site-packages/cmeel.prefix/share", "work", "work/robots", "given", "own"}) {
    const auto file = folder_.write(std::string(folder) + "/dog/urdf/dog.urdf", "");
    EXPECT_EQ(resolve(uri), file);
  }
}

TEST_F(PackagePath, SaysWhichEnvironmentsItLookedInto) {
  const std::string message = test::message_of(folder_.path(), [&] { resolve("package://dog/urdf/dog.urdf"); });
  for (const char* folder : {"work/robots", "work", "elsewhere/deep", "elsewhere", "clone"}) {
    EXPECT_NE(message.find(std::string("\n  ") + folder + "/.venv"), std::string::npos) << message;
  }
}

TEST_F(PackagePath, TakesAFolderThatIsThePackage) {
  const auto file = folder_.write("src/dog/urdf/dog.urdf", "");
  EXPECT_EQ(resolve_uri("package://dog/urdf/dog.urdf", "/dog.toml", {},
                        {.folders = {folder_.path() / "src/dog/"}, .working_directory = {}}),
            file);
}

TEST_F(PackagePath, RefusesWhatIsNoPath) {
  EXPECT_THROW(resolve("file:///etc/passwd"), InputError);
  EXPECT_THROW(resolve("package://"), InputError);
  EXPECT_THROW(resolve("package://dog"), InputError);
  EXPECT_THROW(resolve("package://dog/"), InputError);
  EXPECT_THROW(resolve("dog.urdf"), InputError);
}

TEST_F(PackagePath, StaysInsideThePackage) {
  folder_.write("work/secret.urdf", "");
  folder_.write("work/dog/urdf/dog.urdf", "");
  EXPECT_NO_THROW(resolve("package://dog/urdf/../urdf/dog.urdf"));
  for (const char* uri : {"package://dog/../secret.urdf", "package://dog/urdf/../../secret.urdf",
                          "package://../work/secret.urdf", "package://./secret.urdf", "package://dog//etc/passwd"}) {
    EXPECT_NE(test::message_of(folder_.path(), [&] { resolve(uri); }).find("leaves its package"), std::string::npos)
        << uri;
  }
}

}  // namespace
}  // namespace prowl
