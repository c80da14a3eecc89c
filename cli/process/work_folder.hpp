#pragma once

#include <filesystem>

namespace prowl::cli {

/// A folder for files until all are there, in the system's place for temporary ones; removed at the end.
class WorkFolder {
 public:
  /// Throws FileError.
  WorkFolder();
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace prowl::cli
