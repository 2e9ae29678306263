#include "dynamics/schemes/make_scheme.h"

#include "dynamics/schemes/explicit_scheme.h"
#include "dynamics/schemes/implicit_scheme.h"
#include "dynamics/schemes/semi_implicit_scheme.h"

namespace glisson {

std::unique_ptr<Scheme> make_scheme(Body body, const SimulationOptions& options) {
  switch (options.integrator) {
    case Integrator::semi_implicit:
      return std::make_unique<SemiImplicitScheme>(std::move(body), options);
    case Integrator::explicit_:
      return std::make_unique<ExplicitScheme>(std::move(body), options);
    case Integrator::implicit:
    case Integrator::static_:
      return std::make_unique<ImplicitScheme>(std::move(body), options);
  }
  return nullptr;
}

}  // namespace glisson
