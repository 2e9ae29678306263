// live_body.h — a variant whose tools are led by hand, and that is cut and changed by it.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "glisson/scene/scene.h"
#include "view/engine/grab_spring.h"
#include "view/engine/hand_cut.h"
#include "view/engine/live_path.h"
#include "view/state/snapshot.h"

namespace glisson::view {

class LiveBody {
 public:
  /// @throws SceneError, std::invalid_argument where the variant has more tools than can be led
  LiveBody(const Variant& variant, const MeshLoader& load);

  BuiltVariant& built() { return *built_; }
  const BuiltVariant& built() const { return *built_; }
  const Variant& variant() const { return variant_; }
  const std::vector<ToolInfo>& tools() const { return tools_; }
  LivePath& way(std::size_t tool) { return *ways_[tool]; }
  std::size_t ways() const { return ways_.size(); }
  /// Null where the integrator supports no interactions.
  GrabSpring* grab() { return grab_.get(); }
  /// Null where the body cannot be cut; why says so.
  HandCut* cut() { return cut_.get(); }
  const HandCut* cut() const { return cut_.get(); }
  const std::string& why_no_cut() const { return why_no_cut_; }
  /// Takes over the tissues of the same variant with other numbers; all else goes on. @throws std::invalid_argument with
  /// nothing changed
  void set_tissues(const Variant& changed);
  /// Lets the hand's blade go on where that is due. @throws std::invalid_argument
  void work_on_cut(HandCut::Clock::time_point now);

  /// Goes back to where the first step was made, whole and with the present tissues; tools are where they started, the hand lets go.
  void reset();
  /// A time to go back to: with the body its cuts, and the paths of the tools.
  struct Kept {
    State state;
    std::optional<HandCut::Kept> cut;
    std::size_t hand_cuts = 0;
    std::vector<LivePath> ways;
  };
  Kept keep() const;
  /// The hand lets go; tissues stay what they are now.
  void go_back(const Kept& kept);

  const Instrument& instrument(std::size_t tool) const { return *built_->instruments[tool]; }
  /// Of its way at force_time(), along its x and y [m].
  std::array<double, 2> aside(std::size_t tool) const;
  ToolState tool_state(std::size_t tool) const;
  std::shared_ptr<const BodyShape> shape() const;
  const std::shared_ptr<const std::map<int, Tissue>>& tissues() const { return tissues_; }
  /// Changes when the shape does: a scene's blade makes vertices, capsules tear, and nothing here removes tets.
  std::size_t shape_key() const {
    return built_->simulation.mesh().vertices.size() + hand_cuts_ + torn_triangles(built_->capsules).size();
  }

 private:
  void lead_tools();
  void lead_instruments();
  void feel_the_body(const Variant& scene);
  void attach_grab();
  void take_blade();

  Variant variant_;
  std::vector<ToolInfo> tools_;
  std::vector<std::shared_ptr<LivePath>> ways_;
  std::unique_ptr<BuiltVariant> built_;
  std::shared_ptr<const SkinFaces> skin_;
  std::shared_ptr<const std::map<int, Tissue>> tissues_;
  std::shared_ptr<GrabSpring> grab_;
  std::unique_ptr<HandCut> cut_;
  std::string why_no_cut_;
  std::optional<HandCut::Kept> uncut_;  ///< the blade when the body was made
  std::size_t hand_cuts_ = 0;
};

}  // namespace glisson::view
