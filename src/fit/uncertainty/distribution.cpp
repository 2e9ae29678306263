// distribution.cpp — the only file that knows Boost.Math.
#include "fit/uncertainty/distribution.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace glisson::fit {

double student_quantile(double probability, double freedom) {
  return boost::math::quantile(boost::math::students_t(freedom), probability);
}

double chi_squared_tail(double x, double freedom) {
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(freedom), x));
}

}  // namespace glisson::fit
