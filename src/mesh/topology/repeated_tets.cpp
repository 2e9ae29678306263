#include "mesh/topology/repeated_tets.h"

#include <algorithm>

#include "mesh/topology/buckets.h"

namespace glisson::detail {

void for_each_repeated_tet(std::span<const Tet> tets, std::size_t vertices,
                           const std::function<void(std::uint32_t first, std::uint32_t again)>& visit) {
  struct SortedTet {
    Triangle others;
    std::uint32_t tet;
    bool operator<(const SortedTet& b) const { return others != b.others ? others < b.others : tet < b.tet; }
  };
  auto by_lowest = make_buckets<SortedTet>(vertices, [&](const auto& sink) {
    for (std::uint32_t t = 0; t < tets.size(); ++t) {
      Tet v = tets[t];
      std::sort(v.begin(), v.end());
      sink(v[0], SortedTet{{v[1], v[2], v[3]}, t});
    }
  });
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto bucket = by_lowest.bucket(v);
    std::sort(bucket.begin(), bucket.end());
    std::size_t first = 0;
    for (std::size_t i = 1; i < bucket.size(); ++i) {
      if (bucket[i].others != bucket[first].others) first = i;
      if (first != i) visit(bucket[first].tet, bucket[i].tet);
    }
  }
}

}  // namespace glisson::detail
