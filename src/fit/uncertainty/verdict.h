// verdict.h — what a proof means, in words that an experimenter can act on.
#pragma once

#include <string>
#include <vector>

#include "fit/search/problem.h"
#include "fit/uncertainty/covariance.h"
#include "fit/uncertainty/profile.h"

namespace glisson::fit {

enum class Verdict { identified, weak, not_identifiable, at_bound };
const char* name_of(Verdict verdict);

struct ParameterVerdict {
  Verdict verdict = Verdict::identified;
  Interval interval;  ///< by profile where there is one, else by curvature; own unit
  std::string words;  ///< one sentence
};

struct Verdicts {
  std::vector<ParameterVerdict> of;      ///< one for each parameter
  std::vector<std::string> conclusions;  ///< of combinations: which are fixed, which are entangled, the least known
};

/// Judges each parameter by its interval, after [Raue2009]:
///
///   not identifiable   part of a direction that the curves do not see, or open at both ends
///   at bound           the optimum stands at one of its bounds, and the cost between them is not flat
///   weak               open at one end, or wide: a factor of 4 from end to end where it is of one sign, else half its bounds
///   identified         else
///
/// An end counts as open too where it leans on another parameter's bound, and where a forward run failed.
/// @param profiled  of the same optimum; nullptr: by curvature alone
Verdicts judge(const Problem& problem, const Covariance& covariance, const Profiles* profiled = nullptr);

}  // namespace glisson::fit
