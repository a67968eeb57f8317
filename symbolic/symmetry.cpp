#include "symbolic/symmetry.h"

#include <fmt/format.h>

#include <algorithm>

#include "symbolic/elaborate.h"
#include "symbolic/exact_checks.h"
#include "symbolic/material_axes.h"
#include "symbolic/natural.h"
#include "symbolic/sample_states.h"

namespace ergon {
namespace {

using Group = MaterialSymmetry::Group;

constexpr int wanted = 3, attempts = 96;  // states, nearer to rest after every eighth

ClnNumber value(const Energy& energy, const std::string& case_name, const ExactInputs& inputs) {
  ClnAlgebra algebra(inputs, axis_digits);
  return elaborate(energy, case_name, algebra).value;
}

std::vector<Rational> random_turn(StateSampler& sampler, int columns) {
  if (columns == 3) return sampler.rotation();
  return turn_by(coordinate_axis(2), sampler.fraction(9, 4));
}

// The density with fixed data at a few F of finite value.
class Turned {
 public:
  Turned(const Energy& energy, const std::string& case_name, ExactInputs data, StateSampler& sampler)
      : energy_(energy), case_(case_name), data_(std::move(data)), columns_(energy.find("F")->shape.cols) {
    for (int attempt = 0; attempt < attempts && states_.size() < wanted; ++attempt) {
      ExactInputs state = data_;
      state["F"] = sampler.any(energy).at("F");
      const std::vector<Rational> rest = undeformed(energy.find("F")->shape);
      for (size_t i = 0; i < rest.size(); ++i) state["F"][i] = rest[i] + (state["F"][i] - rest[i]) / (1 + attempt / 8);
      const ClnNumber at = value(energy, case_name, state);
      if (at.defined) states_.push_back({state.at("F"), at.value});
    }
  }

  bool defined() const { return states_.size() == wanted; }
  bool flat() const { return columns_ == 2; }
  const ExactInputs& data() const { return data_; }

  // psi(R' F Q) = psi(F).
  bool keeps(const std::vector<Rational>& R) const {
    for (const State& state : states_) {
      ExactInputs inputs = data_;
      inputs["F"] = turned(state.F, R);
      const ClnNumber at = value(energy_, case_, inputs);
      if (!at.defined || cln::abs(at.value - state.value) > axis_tolerance * (1 + cln::abs(state.value))) return false;
    }
    return true;
  }

  // The largest of 0 (any angle), 6, 4, 3, 2 such that a turn by that part of a whole one about the axis keeps the
  // value, or 1.
  int order(const Axis& axis) const {
    const bool in_plane = flat() && !parallel(axis, coordinate_axis(2));
    if (!in_plane && keeps(turn_by(axis, Rational(3) / 7))) return 0;
    for (const int n : {6, 4, 3, 2})
      if ((!in_plane || n == 2) && keeps(part_of_turn(axis, n))) return n;
    return 1;
  }

 private:
  struct State {
    std::vector<Rational> F;
    cln::cl_R value;
  };

  std::vector<Rational> turned(const std::vector<Rational>& F, const std::vector<Rational>& R) const {
    std::vector<Rational> out;
    for (int j = 0; j < columns_; ++j) {
      for (int i = 0; i < 3; ++i) {
        Rational sum(0);
        for (int k = 0; k < 3; ++k)
          for (int l = 0; l < columns_; ++l)
            sum = sum + R[static_cast<size_t>(3 * i + k)] * F[static_cast<size_t>(3 * l + k)] *
                            R[static_cast<size_t>(3 * j + l)];
        out.push_back(sum);
      }
    }
    return out;
  }

  const Energy& energy_;
  const std::string& case_;
  ExactInputs data_;
  int columns_;
  std::vector<State> states_;
};

// As `axes` name it, if they do.
NamedAxis named(const Axis& axis, const std::vector<NamedAxis>& axes) {
  for (const NamedAxis& other : axes)
    if (parallel(other.axis, axis)) return other;
  return {"", axis};
}

struct Found {
  Group group = Group::none;
  std::vector<NamedAxis> axes;
};

Group about_one(int order) {
  switch (order) {
    case 6:
      return Group::hexagonal;
    case 4:
      return Group::tetragonal;
    case 3:
      return Group::trigonal;
    default:
      return order == 2 ? Group::monoclinic : Group::none;
  }
}

// Half a turn about the normal keeps what sees strain alone, so that it tells nothing; half a turn about an axis in the
// plane is a mirror.
Found of_membrane(const Turned& density, const std::vector<NamedAxis>& axes) {
  const int order = density.order(coordinate_axis(2));
  if (order == 0) return {Group::isotropic, {}};
  Found found{order > 2 ? about_one(order) : Group::none, {}};
  for (const NamedAxis& axis : axes) {
    if (density.order(axis.axis) != 2) continue;
    if (order <= 2) found.group = Group::orthotropic;
    found.axes = {axis, named(across(coordinate_axis(2), axis.axis), axes)};
    break;
  }
  return found;
}

Found of_solid(const Turned& density, const std::vector<NamedAxis>& axes) {
  std::vector<NamedAxis> twofold;
  Found found;  // about a single axis
  for (const NamedAxis& axis : axes) {
    const int order = density.order(axis.axis);
    if (order == 0) return {Group::transversely_isotropic, {axis}};
    if (order % 2 == 0) twofold.push_back(axis);
    if (about_one(order) < found.group) found = {about_one(order), {axis}};
  }
  for (size_t i = 0; i < twofold.size(); ++i) {
    for (size_t j = i + 1; j < twofold.size(); ++j) {
      const Axis &a = twofold[i].axis, &b = twofold[j].axis;
      if (!perpendicular(a, b)) continue;
      const Axis c = across(a, b);
      const std::vector<NamedAxis> all = {twofold[i], twofold[j], named(c, axes)};
      if (density.keeps(part_of_turn(diagonal_of(a, b, c), 3))) return {Group::cubic, all};
      if (found.group > Group::orthotropic) found = {Group::orthotropic, all};
    }
  }
  return found;
}

Found found_at(const Energy& energy, const std::string& case_name, const Turned& density, StateSampler& sampler) {
  const int columns = density.flat() ? 2 : 3;
  bool isotropic = true;
  for (int i = 0; i < 2; ++i) isotropic = isotropic && density.keeps(random_turn(sampler, columns));
  if (isotropic) return {Group::isotropic, {}};
  std::vector<NamedAxis> axes = declared_axes(energy, density.data());
  const auto names = density.flat() ? std::vector{"the first axis", "the second axis"} : std::vector{"x", "y", "z"};
  for (size_t i = 0; i < names.size(); ++i) add_axis({names[i], coordinate_axis(static_cast<int>(i))}, axes);
  const ScaledShape scaled(energy, case_name, density.data());
  scaled.add_axes_of_stress(axes);
  const auto classify = density.flat() ? of_membrane : of_solid;
  const Found found = classify(density, axes);
  const bool enough = found.group < Group::trigonal || found.group == Group::orthotropic;
  if (enough && !found.axes.empty()) return found;
  scaled.add_axes_of_stiffness(axes);
  return classify(density, axes);
}

}  // namespace

std::optional<MaterialSymmetry> material_symmetry(const Energy& given, const std::string& case_name) {
  if (given.kind != Energy::Kind::density || given.geometry == "line") return std::nullopt;
  const Energy energy = seen_from_natural(given);
  StateSampler sampler;
  std::vector<Found> found;
  for (int i = 0; i < 3; ++i) {
    ExactInputs data = sampler.any(energy);
    for (const Symbol* lag : energy.with_role(Role::lag)) {
      if (lag->name == "Flag") data[lag->name] = undeformed(lag->shape);
      if (energy.renews(lag->name)) data[lag->name].assign(static_cast<size_t>(lag->shape.size()), Rational(0));
    }
    const Turned density(energy, case_name, std::move(data), sampler);
    if (!density.defined()) return std::nullopt;
    found.push_back(found_at(energy, case_name, density, sampler));
  }
  const auto by_group = [](const Found& a, const Found& b) { return a.group < b.group; };
  const Found& least = *std::max_element(found.begin(), found.end(), by_group);
  MaterialSymmetry out{least.group, {}};
  for (const NamedAxis& axis : least.axes) {
    const auto same = [&](const NamedAxis& other) { return parallel(axis.axis, other.axis); };
    const bool fixed = std::all_of(found.begin(), found.end(),
                                   [&](const Found& at) { return std::any_of(at.axes.begin(), at.axes.end(), same); });
    out.axes.push_back(!axis.name.empty() ? axis.name : fixed ? numbers_of(axis.axis) : "an axis that its data give");
  }
  return out;
}

std::string to_string(const MaterialSymmetry& symmetry) {
  const auto listed = [&] {
    const auto& axes = symmetry.axes;
    return axes.size() < 2 ? fmt::format("{}", fmt::join(axes, ""))
                           : fmt::format("{} and {}", fmt::join(axes.begin(), axes.end() - 1, ", "), axes.back());
  };
  switch (symmetry.group) {
    case Group::isotropic:
      return "isotropic";
    case Group::transversely_isotropic:
      return "transversely isotropic about " + listed();
    case Group::cubic:
      return "cubic along " + listed();
    case Group::hexagonal:
      return (symmetry.axes.size() == 2 ? "hexagonal along " : "hexagonal about ") + listed();
    case Group::tetragonal:
      return (symmetry.axes.size() == 2 ? "square along " : "tetragonal about ") + listed();
    case Group::trigonal:
      return (symmetry.axes.size() == 2 ? "trigonal along " : "trigonal about ") + listed();
    case Group::orthotropic:
      return "orthotropic along " + listed();
    case Group::monoclinic:
      return "monoclinic: symmetric in the plane across " + listed();
    case Group::none:
      break;
  }
  return "none: any turn of the shape at rest changes the value";
}

std::optional<Finding> check_symmetry(const Energy& energy, const std::string& case_name) {
  const auto symmetry = material_symmetry(energy, case_name);
  if (!symmetry) return std::nullopt;
  return Finding{Severity::ok, "symmetry", to_string(*symmetry), {}, ""};
}

}  // namespace ergon
