// submesh_archive.cpp — a body of submeshes in a checkpoint.
#include <algorithm>

#include "engine/layout/archive_submeshes.h"
#include "engine/layout/response_batches.h"
#include "engine/submesh_body.h"
#include "engine/submesh_scratch.h"

namespace glisson::engine {

void SubmeshBody::archive_layout(Archive& ar, std::span<const double> nodal_damping) {
  bool as_built = as_built_;
  auto lanes = static_cast<std::uint32_t>(kernels_.lanes);
  ar(as_built, lanes);
  if (as_built) {  // else what has changed here would have to go back; copies of vertices come from changes alone
    return ar.check(as_built_ && submeshes_.record_of_vertex.size() == body_.vertex_count);
  }
  ar.check(lanes > 0 && lanes <= kMaxLanes);
  if (!ar.reads()) return write_submeshes(ar, submeshes_, body_, lanes);
  submeshes_ = read_submeshes(ar, body_, lanes, kernels_.lanes);
  as_built_ = false;
  changer_.forget();
  follow_layout(nodal_damping);
}

/// Steps made, when the branches were kept last, where to look for inverted tets, and the branches in the order of elements.
void SubmeshBody::archive_past(Archive& ar) {
  ar(steps_, since_memory_);
  std::vector<std::uint8_t> looked;
  for (const Looked l : looked_) looked.push_back(static_cast<std::uint8_t>(l));
  ar.all_below(looked, 1 + static_cast<std::size_t>(Looked::inverted));
  for (std::size_t p = 0; p < looked_.size(); ++p) {
    looked_[p] = looked.size() == looked_.size() ? static_cast<Looked>(looked[p]) : Looked::inverted;
  }
  std::vector<std::vector<float>> memory;
  for (const TissueBlock& block : body_.blocks) {
    memory.emplace_back((block.end - block.begin) * memory_numbers(block.tissue), 0.0F);
  }
  const auto for_all = [&](const auto& visit) {
    for (Submesh& part : submeshes_.parts) {
      const TissueBlock& block = body_.blocks[part.block];
      const std::size_t n = memory_numbers(block.tissue);
      for_memory(part, block.tissue, kernels_.lanes, [&](std::uint32_t e, const auto& number) {
        for (std::size_t i = 0; i < n; ++i) visit(*number(i), memory[part.block][(e - block.begin) * n + i]);
      });
    }
  };
  if (!ar.reads()) for_all([](float here, float& kept) { kept = here; });
  for (std::vector<float>& numbers : memory) ar.same_size(numbers);
  if (ar.reads()) for_all([](float& here, float kept) { here = kept; });
}

}  // namespace glisson::engine
