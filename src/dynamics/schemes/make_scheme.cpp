#include "dynamics/schemes/make_scheme.h"

#include <algorithm>
#include <array>

#include "dynamics/schemes/explicit_scheme.h"
#include "dynamics/schemes/implicit_scheme.h"
#include "dynamics/schemes/semi_implicit_scheme.h"

namespace glisson {
namespace {

using Make = std::unique_ptr<Scheme> (*)(Body, const SimulationOptions&);

/// The integrators, each once.
template <class... Schemes>
struct List {
  static constexpr std::array kInfos{Schemes::kInfo...};
  static constexpr std::array<Make, sizeof...(Schemes)> kMakes{
      [](Body body, const SimulationOptions& options) -> std::unique_ptr<Scheme> {
        return std::make_unique<Schemes>(std::move(body), options);
      }...};
};

using All = List<ExplicitScheme,      //
                 SemiImplicitScheme,  //
                 ImplicitScheme,      //
                 StaticScheme>;

std::size_t place_of(Integrator integrator) {
  const auto is_it = [=](const IntegratorInfo& info) { return info.integrator == integrator; };
  return static_cast<std::size_t>(std::find_if(All::kInfos.begin(), All::kInfos.end(), is_it) - All::kInfos.begin());
}

}  // namespace

Capabilities capabilities(Integrator integrator) { return All::kInfos.at(place_of(integrator)).can; }

std::string supporting_integrators() {
  std::string words;
  for (const IntegratorInfo& info : All::kInfos) {
    if (!info.can.supports_interactions) continue;
    words += (words.empty() ? "" : ", or ") + std::string(word_of(info.integrator));
    if (!info.can.supports_them_in_viscous_tissue) words += " for tissue without `viscosity_Pa_s`";
  }
  return words;
}

std::unique_ptr<Scheme> make_scheme(Body body, const SimulationOptions& options) {
  return All::kMakes.at(place_of(options.integrator))(std::move(body), options);
}

}  // namespace glisson
