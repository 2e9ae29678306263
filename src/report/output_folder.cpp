// output_folder.cpp — see output_folder.h.
#include "report/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "report/output_file.h"
#include "scene/parse/result_names.h"

namespace glisson {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = ".glisson";
constexpr const char* kMarkText = "Results of glisson. A new run into this folder replaces them.\n";

struct Holder {
  long process = 0;     ///< 0: the system does not tell
  bool inside = false;  ///< it writes to a folder inside: its lock is shared
};

/// The process that holds a lock on a folder.
Holder holder_of(const struct stat& folder) {
  std::ifstream locks("/proc/locks");  // "1: FLOCK ADVISORY WRITE 123 08:01:456 0 EOF"
  const std::string inode = ":" + std::to_string(folder.st_ino);
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number, kind, how, access, place;
    long process = 0;
    if (!(words >> number >> kind >> how >> access >> process >> place)) continue;  // "->": one that waits
    if (kind == "FLOCK" && place.ends_with(inode) && process > 0 && process != getpid())
      return {process, access == "READ"};
  }
  return {};
}

/// Whether a file is of a study: `glisson.sweep` of Python writes one a point.
bool is_study_file(const std::string& name) {
  return name.starts_with("point-") && (name.ends_with(".parquet") || name.ends_with(".part"));
}

/// Whether a run could write to a folder: it has the mark, or holds nothing but the way to a folder inside it and files of a study.
bool could_be_output(const fs::path& folder, const fs::path& inside) {
  std::error_code error;
  if (fs::exists(folder / kMark, error)) return true;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const fs::path name = at->path().filename();
    if (name != inside.filename() && !is_study_file(name.string())) return false;
  }
  return !error;
}

}  // namespace

OutputFolder::OutputFolder(fs::path folder, const std::function<void(const std::string&)>& warn, std::string way_out)
    : folder_(std::move(folder)), way_out_(std::move(way_out)) {
  constexpr int kMostTries = 10;  // a run that ends may remove the folder that it made while this one opens it
  try {
    for (int i = 0; i < kMostTries; ++i) {
      make();
      if (lock(warn)) return;
    }
    throw OutputError(folder_.string() + ": is removed and made again by another process; " + way_out_);
  } catch (...) {
    remove_made();
    unlock();
    throw;
  }
}

OutputFolder::~OutputFolder() {
  remove_made();
  unlock();
}

void OutputFolder::refuse(const std::string& reason) const {
  throw std::invalid_argument(folder_.string() + ": " + reason + "; " + way_out_ + ", or empty this one yourself");
}

/// That another run writes to a folder, or to one inside it, and the way out.
std::string OutputFolder::other_run(const fs::path& folder, int descriptor) const {
  struct stat locked {};
  const Holder holder = fstat(descriptor, &locked) == 0 ? holder_of(locked) : Holder{};
  return folder.string() + ": another run is being written " + (holder.inside ? "inside it" : "there") +
         (holder.process > 0 ? " by process " + std::to_string(holder.process) : std::string()) +
         ", and two would mix their files; wait for its end, end it, or " + way_out_;
}

/// Files and folders of a former run, the deepest first. Links are not followed and are not ours.
std::vector<fs::path> OutputFolder::former_run() const {
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_)) {
    const bool ours =
        !entry.is_symlink() &&
        (entry.is_directory() || (entry.is_regular_file() && scene::is_result_file(entry.path().filename().string())));
    if (!ours) refuse("holds " + entry.path().lexically_relative(folder_).string() + ", which glisson did not write");
    found.push_back(entry.path());
  }
  return {found.rbegin(), found.rend()};
}

void OutputFolder::unlock() {
  if (descriptor_ >= 0) close(descriptor_);
  for (const int above : above_) close(above);
  descriptor_ = -1;
  above_.clear();
}

void OutputFolder::make() {
  std::error_code error;
  const fs::file_status now = fs::status(folder_, error);
  if (fs::exists(now) && !fs::is_directory(now)) refuse("is a file, not a folder");
  std::vector<fs::path> missing;
  for (fs::path at = fs::absolute(folder_); !at.empty() && !fs::exists(at, error); at = at.parent_path()) {
    missing.push_back(at);
    if (at == at.parent_path()) break;
  }
  make_folder(folder_);
  made_.assign(missing.rbegin(), missing.rend());
}

/// Those that are still empty.
void OutputFolder::remove_made() {
  std::error_code ignored;
  for (auto at = made_.rbegin(); at != made_.rend(); ++at) fs::remove(*at, ignored);
  made_.clear();
}

/// @return false where the folder was another one by the time it was locked
bool OutputFolder::lock(const std::function<void(const std::string&)>& warn) {
  unlock();
  descriptor_ = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0 && errno == ENOENT) return false;
  struct stat locked {};
  const bool taken = descriptor_ >= 0 && flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
  const int reason = errno;
  if (!taken && descriptor_ >= 0 && reason == EWOULDBLOCK) {
    made_.clear();
    throw std::invalid_argument(other_run(folder_, descriptor_));
  }
  if (!taken) {
    if (warn) {
      warn(folder_.string() + ": cannot be locked (" + std::strerror(reason) +
           "): nothing keeps a second run from writing there too; take care that there is none");
    }
    return true;
  }
  struct stat there {};
  const bool same = fstat(descriptor_, &locked) == 0 && stat(folder_.c_str(), &there) == 0 &&
                    locked.st_ino == there.st_ino && locked.st_dev == there.st_dev;
  if (same) lock_above();
  return same;
}

/// Shares the folders around it with other runs that are inside them. @throws std::invalid_argument where one of them is another run's
void OutputFolder::lock_above() {
  std::error_code error;
  fs::path inside = fs::canonical(folder_, error);
  for (; !error && inside.has_relative_path(); inside = inside.parent_path()) {
    const fs::path at = inside.parent_path();
    const int above = could_be_output(at, inside) ? open(at.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
    if (above < 0) continue;
    above_.push_back(above);
    if (flock(above, LOCK_SH | LOCK_NB) == 0 || errno != EWOULDBLOCK) continue;
    throw std::invalid_argument(folder_.string() + " is inside the folder of another run. " + other_run(at, above));
  }
}

void OutputFolder::prepare() {
  try {
    if (!fs::is_empty(folder_)) {
      if (!fs::exists(folder_ / kMark)) refuse("is not empty and holds no results of glisson");
      for (const fs::path& file : former_run()) fs::remove(file);
    }
  } catch (const fs::filesystem_error& error) {
    throw OutputError(folder_.string() + ": cannot be prepared: " + error.code().message() + "; " + way_out_);
  }
  write_whole(folder_ / kMark, kMarkText);
  made_.clear();
}

}  // namespace glisson
