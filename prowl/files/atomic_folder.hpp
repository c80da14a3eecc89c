#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>

namespace prowl {

/// Absolute path without symbolic links or a slash at the end: a write replaces the folder, not a link to it. The
/// folder need not exist. Throws FileError.
std::filesystem::path real_path(const std::filesystem::path& folder);

/// Throws FileError unless write_folder_atomically should work: `folder` is missing, empty, or contains only files
/// named in `own_names` ("a.txt", "folder/b.txt"), is no mount point, and this user can make and rename a folder there,
/// which is tried. For a check before hours of work.
void check_replaceable(const std::filesystem::path& folder, const std::set<std::string>& own_names);

/// Makes `folder` contain exactly these files (name -> content), whole or not at all: writes and syncs them in a folder
/// beside it, which takes its place by one rename; then removes the old content. Refuses a folder that contains
/// anything not in `own_names`. On FileError the old content is unchanged; if only the last step failed, the message
/// names the folder of the new content: FOLDER.prowl-PID.new.
///
/// A killed process leaves its files beside the folder, as ".prowl-PID-N.new"; the next writer removes those older than
/// an hour. If the file system cannot exchange folders (some network ones), a kill between two renames leaves the old
/// content as FOLDER.prowl-PID.old.
void write_folder_atomically(const std::filesystem::path& folder, const std::map<std::string, std::string>& files,
                             const std::set<std::string>& own_names);

/// Throws FileError unless write_files_atomically should work: makes a folder in the folder and removes it again. For a
/// check before hours of work.
void check_writable(const std::filesystem::path& folder);

/// Writes files into a folder that may contain others: writes and syncs all beside them, then renames one after the
/// other. On FileError all old files are unchanged, unless a rename failed. A kill between two renames leaves each file
/// whole, old or new.
void write_files_atomically(const std::filesystem::path& folder, const std::map<std::string, std::string>& files);

/// The same for one file. On FileError the old file is unchanged.
void write_file_atomically(const std::filesystem::path& file, const std::string& text);

}  // namespace prowl
