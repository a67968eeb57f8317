#include "codegen/convexity.h"

#include <algorithm>

#include "codegen/intervals.h"

namespace ergon {
namespace {

struct Curvature {
  bool moves = false;  // depends on q
  bool convex = true, concave = true;
  bool affine() const { return convex && concave; }
};

constexpr Curvature kUnknown = {true, false, false};

Curvature scaled(const Curvature& c, const Interval& by) {
  if (by.nonnegative()) return c;
  if (by.nonpositive()) return {c.moves, c.concave, c.convex};
  return {c.moves, c.affine(), c.affine()};
}

class Curvatures {
 public:
  explicit Curvatures(const Module& module) : g_(module.graph), intervals_(find_intervals(module)) {
    for (NodeId id = 0; id < g_.size(); ++id) known_.push_back(find(id));
  }
  const Curvature& of(NodeId id) const { return known_[static_cast<size_t>(id)]; }

 private:
  const Interval& interval(NodeId id) const { return intervals_[static_cast<size_t>(id)]; }

  Curvature find(NodeId id) const {
    const Node& n = g_[id];
    switch (n.kind) {
      case Node::Kind::constant:
        return {};
      case Node::Kind::input:
        return {n.source == Source::q || n.source == Source::point, true, true};
      case Node::Kind::sum: {
        Curvature sum;
        for (const Term& t : n.terms) {
          const Curvature c = scaled(of(t.node), {t.coefficient, t.coefficient});
          sum = {sum.moves || c.moves, sum.convex && c.convex, sum.concave && c.concave};
        }
        return sum;
      }
      case Node::Kind::product:
        return of_product(n);
      case Node::Kind::call:
        return of_call(n);
    }
    return kUnknown;
  }

  // One factor that moves, times what does not.
  Curvature of_product(const Node& n) const {
    Curvature moving;
    int sign = 1;  // of the others; 0 when not known
    for (const Factor& f : n.factors) {
      if (!of(f.base).moves) {
        const bool positive = f.num % 2 == 0 || f.den > 1 || interval(f.base).nonnegative();
        sign = positive ? sign : interval(f.base).nonpositive() ? -sign : 0;
        continue;
      }
      if (moving.moves) return kUnknown;
      moving = of_power(f);
      moving.moves = true;
    }
    return scaled(moving, {sign == 0 ? -1.0 : sign, sign == 0 ? 1.0 : sign});
  }

  Curvature of_power(const Factor& f) const {
    const Curvature& base = of(f.base);
    const Interval& range = interval(f.base);
    if (f.num == 1 && f.den == 1) return base;
    if (f.num == 1 && f.den == 2 && is_sum_of_squares(f.base)) return {true, true, false};
    // What is under a root is not negative where it is defined.
    const bool nonnegative = range.nonnegative() || f.den > 1;
    if (f.num < 0) return {true, nonnegative && base.concave, false};
    if (f.num < f.den) return {true, false, base.concave};
    const bool even = f.den == 1 && f.num % 2 == 0;
    const bool rising = nonnegative && base.convex, falling = even && range.nonpositive() && base.concave;
    return {true, rising || falling || (even && base.affine()), false};
  }

  // Squares of affine parts with factors that are not negative: the root of it is a norm.
  bool is_sum_of_squares(NodeId id) const {
    const Node& n = g_[id];
    if (n.kind != Node::Kind::sum) return is_square(id);
    if (n.constant < 0) return false;
    return std::all_of(n.terms.begin(), n.terms.end(), [&](const Term& t) {
      const bool fixed = !of(t.node).moves && interval(t.node).nonnegative();
      return t.coefficient > 0 && (fixed || is_square(t.node));
    });
  }
  bool is_square(NodeId id) const {
    const Node& n = g_[id];
    if (n.kind != Node::Kind::product) return false;
    int moving = 0;
    for (const Factor& f : n.factors) {
      const bool square = f.den == 1 && (f.num == 2 ? of(f.base).affine() : f.num == 1 && is_sum_of_squares(f.base));
      if (of(f.base).moves ? !square : !interval(f.base).nonnegative() && f.num % 2 != 0) return false;
      moving += of(f.base).moves;
    }
    return moving == 1;
  }

  Curvature of_call(const Node& n) const {
    bool moves = false;
    for (NodeId a : n.arguments) moves = moves || of(a).moves;
    if (!moves) return {};
    const Curvature& a = of(n.arguments[0]);
    switch (n.call) {
      case Call::exp:
      case Call::expm1:
        return {true, a.convex, false};
      case Call::log:
      case Call::log1p:
        return {true, false, a.concave};
      case Call::abs:
        return {true, a.affine() || (a.convex && interval(n.arguments[0]).nonnegative()), false};
      case Call::max:
        return {true, a.convex && of(n.arguments[1]).convex, false};
      case Call::min:
        return {true, false, a.concave && of(n.arguments[1]).concave};
      default:
        return kUnknown;
    }
  }

  const Graph& g_;
  std::vector<Interval> intervals_;
  std::vector<Curvature> known_;
};

}  // namespace

bool is_convex(const Module& module, NodeId value) { return Curvatures(module).of(value).convex; }

}  // namespace ergon
