#include "engine/layout/patch_chains.h"

#include <algorithm>

#include "element/element_shape.h"
#include "engine/layout/chain_batches.h"
#include "engine/layout/response_batches.h"

namespace glisson::engine {
namespace {

constexpr std::size_t kFewBatches = 8;  ///< that may be added to any submesh, and a quarter of those laid out

/// All elements of the chains in which some of these are.
std::vector<std::uint32_t> with_their_chains(const Submesh& part, const std::vector<std::uint32_t>& turned,
                                             std::size_t lanes) {
  std::vector<std::uint32_t> all;
  for (const std::uint32_t e : turned) {
    if (std::find(all.begin(), all.end(), e) != all.end()) continue;
    const std::vector<std::uint32_t> chain = elements_of_chain(part.chains, place_of_element(part.chains, e), lanes);
    all.insert(all.end(), chain.begin(), chain.end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// Records of the submesh's vertices that it did not have.
std::vector<std::uint32_t> new_records(const Body& body, const std::vector<std::uint32_t>& record_of_vertex,
                                       const std::vector<std::uint32_t>& elements, const Submesh& part) {
  std::vector<std::uint32_t> records;
  for (const std::uint32_t e : elements) {
    for (const std::uint32_t v : body.elements[e]) {
      const std::uint32_t record = record_of_vertex[v];
      const bool inner = record >= part.first_interior && record < part.first_interior + part.interior_count;
      if (!inner && !std::binary_search(part.shared.begin(), part.shared.end(), record)) records.push_back(record);
    }
  }
  std::sort(records.begin(), records.end());
  records.erase(std::unique(records.begin(), records.end()), records.end());
  return records;
}

/// Numbers that a tet keeps beside its chain: where they lie for the element at a place.
std::size_t beside(std::size_t place, std::size_t numbers, std::size_t lanes) {
  return place / lanes * numbers * lanes + place % lanes;
}

/// Takes the Maxwell memory of elements with them, and gives them their fibres.
class ResponseData {
 public:
  ResponseData(const Body& body, Submesh& part, std::span<const std::uint32_t> elements, std::size_t lanes)
      : body_(body), tissue_(body.blocks[part.block].tissue), part_(part), elements_(elements), lanes_(lanes),
        numbers_(memory_numbers(tissue_)) {
    for (const std::uint32_t e : elements) {
      const std::size_t from = beside(place_of_element(part.chains, e), numbers_, lanes);
      for (std::size_t i = 0; i < numbers_; ++i) kept_.push_back(part.memory[from + i * lanes]);
    }
  }

  void put_back() {
    if (numbers_ > 0) part_.memory.resize(part_.chains.element.size() * numbers_, 0.0F);
    if (tissue_.fibres) part_.fibre.resize(part_.chains.element.size() * 3, 0.0F);
    for (std::size_t k = 0; k < elements_.size(); ++k) {
      const std::size_t place = place_of_element(part_.chains, elements_[k]);
      for (std::size_t i = 0; i < numbers_; ++i) {
        part_.memory[beside(place, numbers_, lanes_) + i * lanes_] = kept_[k * numbers_ + i];
      }
      if (!tissue_.fibres) continue;
      const Vec3d a = element_shape(body_, tissue_, elements_[k]).fibre;
      for (std::size_t i = 0; i < 3; ++i) part_.fibre[beside(place, 3, lanes_) + i * lanes_] = static_cast<float>(a[i]);
    }
  }

 private:
  const Body& body_;
  const Tissue& tissue_;
  Submesh& part_;
  std::span<const std::uint32_t> elements_;
  std::size_t lanes_, numbers_;
  std::vector<float> kept_;
};

}  // namespace

bool patch_chains(const Body& body, const std::vector<std::uint32_t>& record_of_vertex, const ChangedElements& changed,
                  Submesh& part, std::size_t lanes) {
  if (part.edges.count > 0) return false;
  const std::vector<std::uint32_t> loose = with_their_chains(part, changed.turned, lanes);
  const std::size_t added = part.chains.count - part.laid_out + (loose.size() + lanes - 1) / lanes;
  if (added > kFewBatches + part.laid_out / 4) return false;
  const std::vector<std::uint32_t> records = new_records(body, record_of_vertex, loose, part);
  if (!records.empty() && !part.shared.empty() && records.front() < part.shared.back()) return false;
  if (part.local_vertices() + records.size() > kMaxLocalVertices) return false;

  part.shared.insert(part.shared.end(), records.begin(), records.end());
  const auto local = [&](std::uint32_t e) {
    Tet t = body.elements[e];
    for (std::uint32_t& v : t) v = part.local_of_record(record_of_vertex[v]);
    return t;
  };
  for (const std::uint32_t e : changed.reshaped) {
    if (std::binary_search(loose.begin(), loose.end(), e)) continue;
    rewrite_element(body, part.chains, place_of_element(part.chains, e), local(e), lanes);
  }
  ResponseData response(body, part, loose, lanes);
  std::vector<Tet> locals;
  for (const std::uint32_t e : loose) {
    clear_element(part.chains, e, lanes);
    locals.push_back(local(e));
  }
  add_chains(body, part.chains, loose, locals, lanes, part.laid_out);
  response.put_back();
  part.gradient_reach =
      std::max({part.gradient_reach, gradient_reach(body, loose), gradient_reach(body, changed.reshaped)});
  return true;
}

}  // namespace glisson::engine
