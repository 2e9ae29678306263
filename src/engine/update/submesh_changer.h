// submesh_changer.h — a body's change carried into its submeshes; only those it touches are laid out anew.
//
//   removed element   chains: its lane is emptied where it lies        edges: its six are assembled anew
//   split vertex      chains: those with corners that changed are made anew, the others stay (patch_chains.h)
//                     edges: the submesh is laid out anew
//                     the copies come last among the state records, as interface vertices: no other record moves
//   moved vertex      chains: the rest data around it are written anew       edges: the submesh is laid out anew
//
// Where the elements are, in records, submeshes and lanes, does not depend on what they are made of, but for one thing: a
// linear tissue is held by its edges, any other by its tets. So a tissue is exchanged as
//   tets → tets     fibre directions and room for branches (moduli and laws are the block's)
//   edges → edges   tensors of elastic edges are assembled anew; viscous ones hold none but shapes and stay
//   edges ↔ tets    the submesh is laid out anew, without the elements that are gone
#pragma once

#include "element/body_change.h"
#include "engine/layout/submesh.h"

namespace glisson::engine {

class SubmeshChanger {
 public:
  /// @param body, @param submeshes  must outlive this @param lanes  for which they are laid out
  SubmeshChanger(const Body& body, Submeshes& submeshes, std::size_t lanes)
      : body_(body), submeshes_(submeshes), lanes_(lanes) {}

  /// The submeshes of the elements that a change is about, ascending.
  std::vector<std::size_t> parts_of(const BodyChange& change);
  /// Follows a change of the body's elements, whose new vertices have records already.
  /// @return whether shared vertices and slots are others now
  bool apply(const BodyChange& change, const detail::VertexStars& stars);
  /// Gives a submesh what it holds of its tissue. @return whether its elements lie elsewhere now, so that it is to be connected
  bool refit(Submesh& part) const;
  /// The submeshes are others now.
  void forget() { part_of_element_.clear(); }

 private:
  void find_parts();
  void take_out(std::uint32_t element, const detail::VertexStars& stars);
  void lay_out_touched(const BodyChange& change);

  const Body& body_;
  Submeshes& submeshes_;
  std::size_t lanes_;
  std::vector<std::uint32_t> part_of_element_;  ///< submesh of each element; empty until something changes
};

}  // namespace glisson::engine
