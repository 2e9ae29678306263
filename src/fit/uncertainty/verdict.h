// verdict.h — what a proof means, in words that an experimenter can act on.
#pragma once

#include <string>
#include <vector>

#include "fit/search/problem.h"
#include "fit/uncertainty/covariance.h"
#include "fit/uncertainty/profile.h"

namespace glisson::fit {

enum class Verdict { identified, negligible, weak, not_identifiable, at_bound };
const char* name_of(Verdict verdict);

struct ParameterVerdict {
  Verdict verdict = Verdict::identified;
  Interval interval;  ///< by profile where there is one, else by curvature; own unit
  std::string words;  ///< two sentences: what is known, and what that means for the force
};

struct Verdicts {
  std::vector<ParameterVerdict> of;      ///< one for each parameter
  std::vector<std::string> conclusions;  ///< of combinations: which are fixed, which are entangled, the least known
};

/// Judges each parameter by its interval, after [Raue2009]:
///
///   not identifiable   part of a direction that the curves do not see, or open at both ends
///   at bound           the optimum stands at one of its bounds, and the cost between them is not flat
///   identified         the interval is of one sign, and a factor of 4 at most from end to end
///   negligible         zero lies within, and over all of it the force changes by less than the residuals' rms
///   weak               else, or open at one end: other parameters make up for it
///
/// Bounds play no part in it: a wide search is no knowledge. The change of force is that of the parameter alone, to first
/// order, rms over the curves, for half the interval.
/// An end counts as open too where it leans on another parameter's bound, and where a forward run failed.
/// @param profiled  of the same optimum; nullptr: by curvature alone, which says nothing of values away from it, and the words say so
Verdicts judge(const Problem& problem, const Covariance& covariance, const Profiles* profiled = nullptr);

}  // namespace glisson::fit
