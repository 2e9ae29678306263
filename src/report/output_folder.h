// output_folder.h — the folder a run writes to: a former run there is replaced, anything else is left alone.
//
// A folder of results carries a file `.glisson`. Without it, a folder that holds anything is someone else's. With it,
// the files that a run writes are ours by name and place; a single other file among them stops the run, so that
// nothing of the user's is ever deleted.
//
// While a run writes, it holds an advisory lock (flock) on the folder itself, which the system releases when the process ends, however
// it ends. A second run is refused; nothing has to be cleaned up after a crash, and threads and children of the run are not concerned.
//
//   out            exclusive lock of a run into it; shared lock of a run into out/a or out/a/b, so that neither goes beside the other
//   out/a          exclusive lock of a run into it
//
// Only folders above that a run could write to are locked: those with `.glisson`, and those that hold nothing but the way down and rows of
// a study (`glisson.sweep`). So runs into out/a and out/b do not meet, nor does one meet a lock that another program has on a working
// folder or a home. Python's runs and studies hold their folders by this class, too.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace glisson {

/// A folder that no other process writes results to while this lives, nor to one inside it or around it.
class OutputFolder {
 public:
  /// Makes the folder, where there is none, and locks it. What has been made is removed again at the end where prepare() was not called.
  /// @param warn  is told where the file system has no locks: nothing then keeps a second run away
  /// @param way_out  of what refuses the folder, in the words of who gave it
  /// @throws std::invalid_argument naming the folder and the process that writes there, inside it or around it @throws OutputError with the reason of the system
  explicit OutputFolder(std::filesystem::path folder, const std::function<void(const std::string&)>& warn = {},
                        std::string way_out = "choose another folder with --out DIR");
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Makes it ready: removes the former run in it, and marks it as ours.
  /// @throws std::invalid_argument naming the file that is not ours @throws OutputError with the reason of the system
  void prepare();

 private:
  void make();
  void remove_made();
  bool lock(const std::function<void(const std::string&)>& warn);
  void lock_above();
  void unlock();
  [[noreturn]] void refuse(const std::string& reason) const;
  std::string other_run(const std::filesystem::path& folder, int descriptor) const;
  std::vector<std::filesystem::path> former_run() const;

  std::filesystem::path folder_;
  std::string way_out_;
  std::vector<std::filesystem::path> made_;  ///< folders that were not there before, the deepest last
  int descriptor_ = -1;                      ///< of the folder, which carries the lock
  std::vector<int> above_;                   ///< of folders around it, each with a shared lock
};

}  // namespace glisson
