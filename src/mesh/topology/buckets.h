// buckets.h — groups items by a small integer key without a map: the tool behind faces and duplicates.
//
// Sorting millions of faces by comparison is slow, and maps of vectors are slower and larger. Every face or
// tet has a smallest vertex; a counting sort by it leaves short buckets (a few dozen items on real meshes)
// that can then be sorted where they lie, inside the cache.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glisson::detail {

/// Items grouped by key; within a bucket in the order in which they were produced.
template <class Item>
struct Buckets {
  std::vector<Item> items;
  std::vector<std::size_t> begin;  ///< one more than keys

  std::span<Item> bucket(std::size_t key) { return std::span(items).subspan(begin[key], begin[key + 1] - begin[key]); }
};

/// Fills buckets 0 … keys − 1. `produce(sink)` is called twice and must call sink(key, item) the same way each time.
template <class Item, class Produce>
Buckets<Item> make_buckets(std::size_t keys, const Produce& produce) {
  Buckets<Item> buckets;
  buckets.begin.assign(keys + 1, 0);
  produce([&](std::size_t key, const Item&) { ++buckets.begin[key + 1]; });
  for (std::size_t k = 0; k < keys; ++k) buckets.begin[k + 1] += buckets.begin[k];
  buckets.items.resize(buckets.begin[keys]);
  std::vector<std::size_t> next(buckets.begin.begin(), buckets.begin.end() - 1);
  produce([&](std::size_t key, const Item& item) { buckets.items[next[key]++] = item; });
  return buckets;
}

}  // namespace glisson::detail
