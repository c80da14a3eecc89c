#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>

namespace prowl {

/// Without symbolic links or a slash at the end: of the folder itself, not of a link to it, which is what is replaced.
/// It need not be there. Throws FileError.
std::filesystem::path real_path(const std::filesystem::path& folder);

/// Throws FileError unless write_folder_atomically can be expected to work: `folder` is missing, empty, or holds only
/// files called as in `own_names` ("a.txt", "folder/b.txt"), and a folder can be made there: it tries; if there is one,
/// nothing is mounted on it and this user may rename it. For a look before hours of work.
void check_replaceable(const std::filesystem::path& folder, const std::set<std::string>& own_names);

/// Makes `folder` hold exactly these files (name -> content), whole or not at all: they are written and synced in a
/// folder beside it, which then takes its place by one rename; what was there before is removed after that. A folder
/// that holds anything not in `own_names` is left alone. Throws FileError, and then the old content is as it was; if
/// all was written and only could not take its place, the message says where the new is: FOLDER.prowl-PID.new.
///
/// A process that is killed leaves what it was writing beside the folder, as ".prowl-PID-N.new"; what is an hour old of
/// that is removed by the next that writes there. Where the file system cannot exchange folders (some network ones), a
/// kill between two renames leaves the old content as FOLDER.prowl-PID.old.
void write_folder_atomically(const std::filesystem::path& folder, const std::map<std::string, std::string>& files,
                             const std::set<std::string>& own_names);

/// Throws FileError unless write_files_atomically can be expected to work: it makes something in the folder and removes
/// it again. For a look before hours of work.
void check_writable(const std::filesystem::path& folder);

/// Files in a folder that holds others, too: written and synced beside them, then renamed one after the other. Throws
/// FileError; unless that came of a rename, all old ones are as they were. A kill between two renames leaves each file
/// whole, old or new.
void write_files_atomically(const std::filesystem::path& folder, const std::map<std::string, std::string>& files);

/// The same for one file. Throws FileError, and then the old one is as it was.
void write_file_atomically(const std::filesystem::path& file, const std::string& text);

}  // namespace prowl
