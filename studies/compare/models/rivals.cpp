// rivals.cpp — the list of models.
#include <array>

#include "compare/models/rival.h"

namespace glisson::models {

std::span<const Rival> rivals() {
  static constexpr std::array kOnce{Effort{}};
  static constexpr std::array kSweeps{Effort{10, 0}, Effort{10, 10}, Effort{10, 100}};
  // Small steps with few sweeps, as its authors advise; with a tenth as many tets collapse between its two constraints.
  static constexpr std::array kXpbd{Effort{1000, 1}, Effort{1000, 5}, Effort{2000, 1}, Effort{4000, 1},
                                    Effort{8000, 1}};
  static constexpr std::array kProjective{Effort{50, 1}, Effort{50, 10}, Effort{400, 10}};
  static constexpr std::array kImplicit{Effort{20, 0}};
  static constexpr std::array kLinearImplicit{Effort{40, 0}, Effort{400, 0}};
  static constexpr std::array kModes{Effort{0, 10}, Effort{0, 40}};
  constexpr std::string_view kNoTurn = "large rotation: forces grow with it; viscosity";
  constexpr std::string_view kNoViscosity = "viscosity, a law of its own";
  constexpr bool kExplicit = true;
  static const std::array list{
      Rival{"spring_mass_volume_rule", "springs along the edges, k = Σ E V/l²", "VanGelder1998",
            "a Poisson's ratio other than 1/4, viscosity, a law", kOnce, spring_mass_by_volume, kExplicit},
      Rival{"spring_mass_length_rule", "springs along the edges, k = Σ 2√2/25 E l", "Lloyd2007",
            "a Poisson's ratio other than 1/4, viscosity, a law", kOnce, spring_mass_by_length, kExplicit},
      Rival{"spring_mass_with_volume", "springs, and tets that resist a change of volume", "Teschner2004",
            "viscosity, a law", kOnce, spring_mass_with_volume, kExplicit},
      Rival{"chain_mail", "linked volumes, relaxed by averaging", "Gibson1999", "forces, true units, viscosity",
            kSweeps, chain_mail},
      Rival{"linear_fem", "linear finite elements, one factor for all", "BroNielsen1998",
            "large rotation, a law, viscosity, cutting without a new factor", kOnce, linear_fem},
      Rival{"linear_fem_implicit", "linear finite elements in motion, backward Euler", "BaraffWitkin1998",
            "large rotation, a law, viscosity, cutting without a new factor", kLinearImplicit, linear_fem_implicit},
      Rival{"linear_fem_modal", "linear finite elements in their lowest modes, corrected", "PentlandWilliams1989",
            "large rotation, a law, viscosity, a cut, loads that its modes were not made for", kModes,
            linear_fem_modal},
      Rival{"linear_tensor_mass", "linear tensor-mass, explicit", "Cotin2000", kNoTurn, kOnce, linear_tensor_mass,
            kExplicit},
      Rival{"hybrid", "half condensed, half linear tensor-mass", "Cotin2000",
            "large rotation, a law, viscosity, cutting the condensed half", kOnce, hybrid, kExplicit},
      Rival{"schwartz_tensor_mass", "tensor-mass with a law of stiffness, explicit", "Schwartz2002",
            "large rotation: forces grow with it", kOnce, schwartz_tensor_mass, kExplicit},
      Rival{"green_tensor_mass", "St Venant–Kirchhoff tensor-mass, explicit", "Picinbono2003",
            "strong compression: the force falls below a stretch of 0.58; viscosity", kOnce, green_tensor_mass,
            kExplicit},
      Rival{"corotational", "linear in the frame of each tet, explicit", "MullerGross2004", "viscosity, a law", kOnce,
            corotational, kExplicit},
      Rival{"neo_hookean", "total Lagrangian neo-Hooke, explicit", "Miller2007", "viscosity", kOnce, neo_hookean,
            kExplicit},
      Rival{"xpbd", "extended position-based dynamics, neo-Hooke", "MacklinMueller2021", kNoViscosity, kXpbd, xpbd},
      Rival{"projective_dynamics", "projective dynamics, shape and volume", "Bouaziz2014", kNoViscosity, kProjective,
            projective_dynamics},
      Rival{"kelvin_voigt", "linear tensor-mass with a dashpot", "Schwartz2002",
            "large rotation, a law, stress that fades while it is held", kOnce, kelvin_voigt, kExplicit},
      Rival{"linear_maxwell", "linear tensor-mass, the tissue's branches", "Taylor1970", "large rotation, a law", kOnce,
            linear_maxwell, kExplicit},
      Rival{"miller_brain", "polynomial of both invariants that fades, explicit", "Miller2000",
            "viscosity other than fading", kOnce, miller_brain, kExplicit},
      Rival{"pioletti_rate", "exponential law, potential of the rate", "Pioletti1998",
            "stress that fades while it is held", kOnce, pioletti_rate, kExplicit},
      Rival{"pioletti_memory", "exponential law that fades, explicit", "Pioletti1998", "viscosity other than fading",
            kOnce, pioletti_memory, kExplicit},
      Rival{"glisson", "the scene's own tissue, explicit", "Schwartz2002", "", kOnce, own_tissue, kExplicit},
      Rival{"glisson_implicit", "the scene's own tissue, long steps", "Schwartz2002", "", kImplicit,
            own_tissue_implicit},
      Rival{"glisson_quasi_static", "the scene's own tissue, equilibria", "Schwartz2002", "inertia, viscosity", kOnce,
            own_tissue_at_rest}};
  return list;
}

}  // namespace glisson::models
