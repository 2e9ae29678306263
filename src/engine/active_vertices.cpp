#include "engine/active_vertices.h"

#include <algorithm>

#include "base/sort_out.h"

namespace glisson::engine {

void ActiveVertices::add(std::span<const std::uint32_t> vertices, std::span<const std::uint32_t> apart) {
  apart_.assign(apart.begin(), apart.end());
  std::vector<std::uint32_t> all(vertices.begin(), vertices.end());
  for (const ActiveVertex& w : active_) all.push_back(w.vertex);
  detail::sort_out(all);
  std::vector<ActiveVertex> now;
  now.reserve(all.size());
  std::size_t known = 0;
  for (const std::uint32_t v : all) {
    const bool was = known < active_.size() && active_[known].vertex == v;
    const std::uint32_t record = submeshes_.record_of_vertex[v];
    now.push_back(was ? active_[known++]
                      : ActiveVertex{v, {}, {}, records_.displacement(record), records_.velocity(record)});
  }
  active_ = std::move(now);
  locate();
}

void ActiveVertices::keep(std::span<const std::uint32_t> vertices) {
  std::erase_if(active_,
                [&](const ActiveVertex& w) { return !std::binary_search(vertices.begin(), vertices.end(), w.vertex); });
  locate();
}

void ActiveVertices::rest(std::span<const std::uint32_t> vertices) {
  resting_.clear();
  for (const std::uint32_t v : vertices) resting_.push_back({v, {}});
  locate();
}

ActiveVertex* ActiveVertices::find(std::uint32_t vertex) {
  const auto w = std::ranges::lower_bound(active_, vertex, {}, &ActiveVertex::vertex);
  return w != active_.end() && w->vertex == vertex ? &*w : nullptr;
}

/// Sorts vertices to the submesh or the chunk of the interface that has them. @param records  theirs, in their order
void ActiveVertices::sort(std::span<const std::uint32_t> records, Lists& lists) const {
  const Interface& shared = submeshes_.interface;
  lists.interior.resize(submeshes_.parts.size());
  lists.interface.resize((shared.size() + kInterfaceChunk - 1) / kInterfaceChunk);
  for (auto& list : lists.interior) list.clear();
  for (auto& list : lists.interface) list.clear();
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sorted;  // record, place
  for (std::uint32_t place = 0; place < records.size(); ++place) sorted.emplace_back(records[place], place);
  std::sort(sorted.begin(), sorted.end());
  std::size_t s = 0;
  for (const auto& [record, place] : sorted) {
    if (record >= shared.first_record) {
      const std::size_t k = record - shared.first_record;
      lists.interface[k / kInterfaceChunk].push_back({static_cast<std::uint32_t>(k % kInterfaceChunk), place});
      continue;
    }
    while (record >= submeshes_.parts[s].first_interior + submeshes_.parts[s].interior_count) ++s;
    lists.interior[s].push_back({static_cast<std::uint32_t>(record - submeshes_.parts[s].first_interior), place});
  }
}

void ActiveVertices::locate() {
  std::vector<std::uint32_t> records;
  std::vector<char> is_apart(records_.size(), 0);
  for (const ActiveVertex& w : active_) {
    records.push_back(submeshes_.record_of_vertex[w.vertex]);
    is_apart[records.back()] = std::binary_search(apart_.begin(), apart_.end(), w.vertex) ? 1 : 0;
  }
  sort(records, active_in_);
  records.clear();
  for (const RestingVertex& r : resting_) records.push_back(submeshes_.record_of_vertex[r.vertex]);
  sort(records, resting_in_);
  holds_apart_.resize(submeshes_.parts.size());
  for (std::size_t p = 0; p < submeshes_.parts.size(); ++p) {
    const Submesh& part = submeshes_.parts[p];
    const std::vector<LocalVertex>& own = active_in_.interior[p];
    const auto asked = [&](std::size_t record) { return is_apart[record] != 0; };
    holds_apart_[p] = std::any_of(own.begin(), own.end(),
                                  [&](const LocalVertex& w) { return asked(part.first_interior + w.local); }) ||
                      std::any_of(part.shared.begin(), part.shared.end(), asked);
  }
}

RecordRun ActiveVertices::interior(std::size_t submesh) const {
  const Submesh& part = submeshes_.parts[submesh];
  return {part.first_interior, part.interior_count, active_in_.interior[submesh], resting_in_.interior[submesh]};
}

RecordRun ActiveVertices::interface(std::size_t chunk) const {
  const Interface& shared = submeshes_.interface;
  const std::size_t begin = chunk * kInterfaceChunk;
  return {shared.first_record + begin, std::min(kInterfaceChunk, shared.size() - begin), active_in_.interface[chunk],
          resting_in_.interface[chunk]};
}

void ActiveVertices::take_forces(const RecordRun& run, const float* elastic, const float* viscous) {
  for (const LocalVertex& at : run.active) {
    ActiveVertex& w = active_[at.place];
    w.elastic = vector_of(elastic + at.local * kForceFloats);
    w.viscous = viscous != nullptr ? vector_of(viscous + at.local * kForceFloats) : Vec3d{};
    w.displacement = records_.displacement(run.first + at.local);
    w.velocity = records_.velocity(run.first + at.local);
  }
  for (const LocalVertex& at : run.resting) {
    Vec3d& force = resting_[at.place].force;
    force = vector_of(elastic + at.local * kForceFloats);
    if (viscous != nullptr) force += vector_of(viscous + at.local * kForceFloats);
  }
}

}  // namespace glisson::engine
