// barrel_model.h — the forward model of a cylinder whose faces stick to the plates or slide with friction.
//
//   F(d) = φ(λ) F₀(d):   F₀ of the homogeneous state (material/uniaxial_path.h) at every instant,
//                        φ what bulging or necking in makes of it, by barrel.h at some stretches, a monotone cubic between them
//
// φ varies slowly and is the same for all curves that are pressed or pulled: two paths of the barrel, one to either side of rest,
// serve them all. It is that of the elastic tissue: of a viscous one exact where strains are small and κ ≫ μ, else an
// approximation. In a creep the load over φ is what the homogeneous specimen is loaded with, found by repetition.
// Shear and torsion hold the faces whatever they are, and deform the specimen alike all over or along its axis.
#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "fit/forward/specimen_model.h"
#include "lab/barrel.h"

namespace glisson::fit {

/// A round specimen and how its faces meet the plates.
struct Plates {
  double radius = 0.0, height = 0.0;  ///< [m], > 0
  lab::Faces faces = lab::Faces::bonded;
  lab::Grip grip;  ///< what of it is no parameter
};

/// Keys of parameters that belong to the plates.
inline constexpr const char *kFrictionKey = "specimen.friction", *kAdhesionKey = "specimen.adhesion_Pa";
inline bool is_plate_key(const std::string& key) { return key == kFrictionKey || key == kAdhesionKey; }

class BarrelModel final : public MotionModel {
 public:
  /// @param keys  of the values; those of the plates are taken here, the others go on to `tissue` in their order
  /// @throws std::invalid_argument for curves that such a specimen cannot make
  BarrelModel(std::vector<Curve> curves, const Plates& plates, TissueAt tissue, std::vector<std::string> keys = {},
              const lab::BarrelGrid& grid = {});
  Prediction predict_from(std::size_t curve, std::span<const double> values, double contact) const override;

 private:
  struct Known;
  /// φ over the strain, > 0 where the specimen is pulled.
  MonotoneCubic<double> factor(std::span<const double> values, double contact) const;
  std::shared_ptr<Known> known(std::span<const double> values, double contact) const;
  std::vector<double> factors_at(const std::vector<double>& strains, std::span<const double> values) const;
  Prediction crept(std::size_t curve, std::span<const double> values, double contact,
                   const MonotoneCubic<double>& factor) const;
  void require_curve(const Curve& curve) const;
  void reach(const Curve& curve);

  std::vector<double> of_tissue(std::span<const double> values) const;
  lab::Grip grip(std::span<const double> values) const;

  Plates plates_;
  TissueAt tissue_;
  std::vector<std::string> keys_;
  SpecimenModel homogeneous_;
  double pressed_ = 0.0, pulled_ = 0.0;  ///< the farthest that curves go to either side, ≥ 0 [m]
  std::shared_ptr<const lab::BarrelMesh> mesh_;
  mutable std::mutex mutex_;
  mutable std::deque<std::shared_ptr<Known>> known_;
};

}  // namespace glisson::fit
