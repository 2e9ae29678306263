// frame_cache.h — frames of a recorded run, read when they are needed and kept within a bound.
#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "view/replay/run_folder.h"
#include "view/state/snapshot.h"

namespace glisson::view {

/// One frame in memory. Frames of one mesh share its shape.
struct LoadedFrame {
  std::shared_ptr<const BodyShape> shape;
  std::vector<Vec3d> displacement;  ///< per vertex [m]
  bool has_fields = false;          ///< whether it was read with these
  std::vector<double> pressure, von_mises,
      contact_pressure;  ///< per tet, per tet, per vertex [Pa]; empty: not in the file
};

class FrameCache {
 public:
  /// @param run  outlives this @param most_bytes  that frames may take; two are always kept
  explicit FrameCache(const RunFolder& run, std::size_t most_bytes = 256'000'000) : run_(run), most_(most_bytes) {}

  /// @return a frame by its number, valid as long as it is held @param fields  with its fields
  /// @throws FileError where it cannot be read; the disk is not asked again then
  std::shared_ptr<const LoadedFrame> at(std::size_t number, bool fields = false);
  /// Whether a frame could be read and is in memory.
  bool has(std::size_t number) const;
  std::size_t bytes() const { return bytes_; }
  std::size_t reads() const { return reads_; }  ///< from the disk so far

 private:
  struct Kept {
    std::size_t number = 0, bytes = 0;
    std::shared_ptr<const LoadedFrame> frame;
  };
  std::shared_ptr<const LoadedFrame> read(std::size_t number, bool fields);
  std::shared_ptr<const LoadedFrame> read_once(std::size_t number, bool fields);

  const RunFolder& run_;
  std::size_t most_, bytes_ = 0, reads_ = 0;
  std::list<Kept> kept_;                           ///< the last used first
  std::map<std::size_t, std::string> unreadable_;  ///< and why
  std::shared_ptr<const BodyShape> shape_;
  std::shared_ptr<const SkinFaces>
      skin_;  ///< of the first frame, once it has been read: what later ones show besides was cut
};

}  // namespace glisson::view
