#include "mesh/partition/tet_chains.h"

#include <algorithm>

namespace glisson::detail {
namespace {

constexpr std::size_t kSearched = 1 << 12;  // tets a search may see: all of a submesh, and longer lists stay cheap

class Cover {
 public:
  explicit Cover(std::span<const Tet> tets)
      : neighbours_(face_neighbours(tets)), chain_of_(tets.size(), kNoTet), free_neighbours_(tets.size()),
        seen_(tets.size(), 0) {}

  /// Takes the tet with the fewest free neighbours again and again, and chains it with the loosest tets beside it.
  void chain_loose_ends() {
    for (std::uint32_t t = size(); t-- > 0;) {
      free_neighbours_[t] =
          static_cast<std::uint8_t>(4 - std::count(neighbours_[t].begin(), neighbours_[t].end(), kNoTet));
      waiting_[free_neighbours_[t]].push_back(t);
    }
    for (std::size_t degree = 0; degree <= 4;) {
      if (waiting_[degree].empty()) {
        ++degree;
        continue;
      }
      const std::uint32_t t = waiting_[degree].back();
      waiting_[degree].pop_back();
      if (!is_free(t) || free_neighbours_[t] != degree) continue;  // an entry that is out of date
      start_chain(t);
      degree = 0;
    }
  }

  /// Joins what is left over: chains of one or two tets grow at the expense of others until there are fewer. Pairs that
  /// were parted leave single tets behind ones that had nowhere to go: those are asked again while that helps.
  void join_leftovers() {
    for (std::uint32_t c = 0; c < chains_.size(); ++c) {
      if (chains_[c].size() == 1) {
        hand_on(chains_[c].middle, 1, kNoTet);
      } else if (chains_[c].size() == 2) {
        dissolve_pair(c);
      }
    }
    for (bool fewer = true; fewer;) {
      fewer = false;
      for (const TetChain& c : chains_) fewer = (c.size() == 1 && hand_on(c.middle, 1, kNoTet)) || fewer;
    }
  }

  std::vector<TetChain> chains() const {
    std::vector<TetChain> result;
    for (std::uint32_t t = 0; t < size(); ++t) {
      const TetChain& c = chains_[chain_of_[t]];
      if (std::min({c.middle, c.ends[0], c.ends[1]}) == t) result.push_back(c);
    }
    return result;
  }

 private:
  /// A tet without a chain, found by freeing it: `entry` of its chain took in `from`, the tet of step `parent`.
  struct Step {
    std::uint32_t tet, parent, entry;
  };

  static TetChain alone(std::uint32_t t) {
    TetChain chain;
    chain.middle = t;
    return chain;
  }
  std::uint32_t size() const { return static_cast<std::uint32_t>(chain_of_.size()); }
  bool is_free(std::uint32_t t) const { return t != kNoTet && chain_of_[t] == kNoTet; }

  /// The free neighbour of `t`, not `other`, that has the fewest free neighbours itself; `best` where none has fewer.
  std::uint32_t loosest_neighbour(std::uint32_t t, std::uint32_t other, std::uint32_t best) const {
    for (const std::uint32_t n : neighbours_[t]) {
      if (n != other && is_free(n) && (best == kNoTet || free_neighbours_[n] < free_neighbours_[best])) best = n;
    }
    return best;
  }

  void start_chain(std::uint32_t t) {
    const std::uint32_t a = loosest_neighbour(t, kNoTet, kNoTet);
    if (a == kNoTet) return add(alone(t));
    const std::uint32_t neighbour_of_t = loosest_neighbour(t, a, kNoTet), b = loosest_neighbour(a, t, neighbour_of_t);
    if (b == neighbour_of_t) {
      add({t, {a, b}});
    } else {
      add({a, {t, b}});
    }
  }

  void add(const TetChain& chain) {
    chains_.push_back(chain);
    own(static_cast<std::uint32_t>(chains_.size() - 1));
    for (const std::uint32_t t : {chain.middle, chain.ends[0], chain.ends[1]}) {
      if (t == kNoTet) continue;
      for (const std::uint32_t n : neighbours_[t]) {
        if (is_free(n)) waiting_[--free_neighbours_[n]].push_back(n);
      }
    }
  }

  void own(std::uint32_t c) {
    for (const std::uint32_t t : {chains_[c].middle, chains_[c].ends[0], chains_[c].ends[1]}) {
      if (t != kNoTet) chain_of_[t] = c;
    }
  }

  /// Both tets of a pair are to find a place elsewhere. Where only one does, the other is left over alone.
  void dissolve_pair(std::uint32_t c) {
    const std::uint32_t a = chains_[c].middle, b = chains_[c].ends[0];
    const std::uint32_t d = static_cast<std::uint32_t>(chains_.size());
    chains_[c] = alone(a);
    chains_.push_back(alone(b));
    chain_of_[b] = d;
    if (!hand_on(a, 2, d)) {
      chains_[c] = {a, {b, kNoTet}};
      chain_of_[b] = c;
      chains_.pop_back();
    }
  }

  /// Breadth first over what a single tet can push out of the chains beside it: end–middle–end takes it in at an end
  /// and lets the other end go, or at the middle and lets either end go. Done when a tet pushed out is beside a
  /// chain of at least `least` tets that is not full, other than `barred`. @return whether it was found, and done
  bool hand_on(std::uint32_t single, std::size_t least, std::uint32_t barred) {
    steps_.assign(1, {single, kNoTet, kNoTet});
    seen_[single] = 1;
    bool found = false;
    for (std::uint32_t i = 0; i < steps_.size() && i < kSearched && !found; ++i) {
      for (const std::uint32_t n : neighbours_[steps_[i].tet]) {
        if (n == kNoTet || chain_of_[n] == barred || is_on_the_way(chain_of_[n], i)) continue;
        const std::size_t met = chains_[chain_of_[n]].size();
        if (met < least) continue;
        if (met < 3) {
          found = true;
          take_path(i, n);
          break;
        }
        push_out(i, n);
      }
    }
    for (const Step& s : steps_) seen_[s.tet] = 0;
    return found;
  }

  bool is_on_the_way(std::uint32_t chain, std::uint32_t step) const {
    for (; step != kNoTet; step = steps_[step].parent) {
      if (chain_of_[steps_[step].tet] == chain) return true;
    }
    return false;
  }

  void push_out(std::uint32_t step, std::uint32_t entry) {
    for (const std::uint32_t out : chains_[chain_of_[entry]].ends) {
      if (out == entry || seen_[out] != 0) continue;
      seen_[out] = 1;
      steps_.push_back({out, step, entry});
    }
  }

  /// The tet of the last step joins the chain of n; each before it takes the place of the next.
  void take_path(std::uint32_t last, std::uint32_t n) {
    changed_.assign(1, chain_of_[n]);
    chains_[chain_of_[steps_[0].tet]] = {};
    for (std::uint32_t i = last; i != 0; i = steps_[i].parent) {
      changed_.push_back(chain_of_[steps_[i].tet]);
      replace(chains_[changed_.back()], steps_[i].tet, steps_[steps_[i].parent].tet, steps_[i].entry);
    }
    TetChain& grown = chains_[changed_[0]];
    grown = {n, {steps_[last].tet, grown.middle == n ? grown.ends[0] : grown.middle}};
    for (const std::uint32_t c : changed_) own(c);
  }

  /// The chain lets `out` go and takes `in` in, beside `entry`.
  static void replace(TetChain& c, std::uint32_t out, std::uint32_t in, std::uint32_t entry) {
    if (entry == c.middle) {
      c.ends[c.ends[0] == out ? 0 : 1] = in;
    } else {
      c = {entry, {in, c.middle}};
    }
  }

  std::vector<Neighbours> neighbours_;
  std::vector<std::uint32_t> chain_of_;
  std::vector<TetChain> chains_;
  std::vector<std::uint8_t> free_neighbours_;
  std::array<std::vector<std::uint32_t>, 5> waiting_;  // by free neighbours; entries may be out of date
  std::vector<char> seen_;
  std::vector<Step> steps_;
  std::vector<std::uint32_t> changed_;
};

}  // namespace

std::vector<TetChain> chain_tets(std::span<const Tet> tets) {
  Cover cover(tets);
  cover.chain_loose_ends();
  cover.join_leftovers();
  return cover.chains();
}

}  // namespace glisson::detail
