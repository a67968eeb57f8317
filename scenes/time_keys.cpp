#include "scenes/time_keys.h"

#include "runtime/solver/integrator.h"
#include "scenes/shape_keys.h"

namespace ergon {

using namespace key_ranges;

namespace {

std::vector<std::string> integrators() {
  std::vector<std::string> out = integrator_names();
  out.insert(out.begin(), "automatic");
  return out;
}

}  // namespace

Section<TimeSettings> time_section() {
  using T = TimeSettings;
  Section<T> out{"[time]", "How long to simulate.", {}, {}, {}};
  out.keys = {
      number_key("dt", &T::dt, "s", positive, Need::required, "length of a time step"),
      number_key("min_dt", &T::min_dt, "s", positive, Need::optional,
                 "a step that fails is tried again with half of its dt, down to this one; steps then grow again up to "
                 "`dt`, and end at all multiples of `dt`",
                 "steps keep their dt; of quasi_static, and with a tolerance, a thousandth of it"),
      number_key("tolerance", &T::tolerance, "m", positive, Need::optional,
                 "error of any position that a step may have by the integrator's estimate: dt follows it, between "
                 "`min_dt` and `dt`; frames are written at multiples of `frame_interval`, or of `dt`",
                 "dt does not follow the error"),
      number_key("end", &T::end, "s", positive, Need::optional, "simulated time", "give `end` or `steps`"),
      integer_key("steps", &T::steps, from_1, Need::optional, "number of time steps", "give `end` or `steps`"),
      choice_key(
          "integrator", &T::integrator, integrators(),
          "automatic: bdf2, with implicit_euler for each step in which bdf2 would make energy, as in hard impacts; of "
          "first order implicit_euler, which "
          "damps; of second bdf2 (one solve per step), sdirk2 and tr_bdf2 (two), "
          "which damp little, newmark, generalised_alpha and midpoint, which damp next to nothing; midpoint and "
          "generalised_alpha go on beyond the state they solve for, which contact may forbid: the step then fails; "
          "quasi_static knows no inertia: each step ends in an equilibrium, of loads (gravity, [[object.load]], and "
          "laws that state `load`) that grow in proportion to time, up to the end of the scene where they act in full, "
          "and of scripted "
          "motions at that time"),
  };
  out.check = [](const std::string&, const T& time) {
    if (time.end && time.steps)
      throw SourceError(time.at("steps"), "[time] has both 'end' and 'steps'; keep one of them");
    if (!time.end && !time.steps)
      throw SourceError(time.place, "[time] lacks 'end' (simulated time, in s) or 'steps' (number of time steps)");
    if (time.min_dt && *time.min_dt > time.dt)
      throw SourceError(time.at("min_dt"),
                        fmt::format("'min_dt' is {} s, which is above 'dt', {} s", *time.min_dt, time.dt));
    if (time.tolerance && time.quasi_static())
      throw SourceError(time.at("tolerance"),
                        "'tolerance' has no use for quasi_static: without inertia a step has no error in time; the one "
                        "of Newton's method is [solver] tolerance");
    constexpr double most = 1e9;
    if (time.end && *time.end / time.dt > most)
      throw SourceError(time.at("end"),
                        fmt::format("{} s in steps of {} s are {:.3g} steps; at most {:.3g} are counted", *time.end,
                                    time.dt, *time.end / time.dt, most));
  };
  return out;
}

}  // namespace ergon
