#include "codegen/graph.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

namespace ergon {
namespace {

std::uint64_t mix(std::uint64_t h, std::uint64_t v) {
  h ^= v + 0x9e3779b97f4a7c15ull + (h << 6) + (h >> 2);
  return h * 0xff51afd7ed558ccdull;
}

std::uint64_t hash_of(const Node& n) {
  std::uint64_t h = mix(static_cast<std::uint64_t>(n.kind), std::bit_cast<std::uint64_t>(n.constant));
  h = mix(h, static_cast<std::uint64_t>(n.source) * 1000003u + static_cast<std::uint64_t>(n.index));
  for (const Term& t : n.terms)
    h = mix(mix(h, std::bit_cast<std::uint64_t>(t.coefficient)), static_cast<std::uint64_t>(t.node));
  for (const Factor& f : n.factors)
    h = mix(mix(h, static_cast<std::uint64_t>(f.base)), static_cast<std::uint64_t>(f.num * 64 + f.den));
  if (n.kind == Node::Kind::call) h = mix(h, static_cast<std::uint64_t>(n.call));
  for (NodeId a : n.arguments) h = mix(h, static_cast<std::uint64_t>(a));
  return h;
}

bool same(const Node& a, const Node& b) {
  return a.kind == b.kind && std::bit_cast<std::uint64_t>(a.constant) == std::bit_cast<std::uint64_t>(b.constant) &&
         a.source == b.source && a.index == b.index && a.terms == b.terms && a.factors == b.factors &&
         a.call == b.call && a.arguments == b.arguments;
}

void reduce(Factor& f) {
  int g = std::gcd(std::abs(f.num), f.den);
  if (g > 1) f.num /= g, f.den /= g;
}

}  // namespace

namespace {

// Series where the closed form would lose digits; the sums of a few dozen terms are exact to rounding.
double log1pmx(double x) {
  if (!(std::abs(x) < 0.5)) return std::log1p(x) - x;
  const double z = x / (2 + x), z2 = z * z;  // log(1 + x) = 2 atanh(z)
  double sum = 0;
  for (int k = 20; k >= 0; --k) sum = sum * z2 + 1.0 / (2 * k + 3);
  return 2 * z * z2 * sum - x * z;
}

double expm1mx(double x) {
  if (!(std::abs(x) < 0.5)) return std::expm1(x) - x;
  double sum = 1;
  for (int k = 20; k >= 3; --k) sum = 1 + sum * x / k;
  return 0.5 * x * x * sum;
}

double sinmx(double x) {
  if (!(std::abs(x) < 1)) return std::sin(x) - x;
  double sum = 1;
  for (int k = 12; k >= 2; --k) sum = 1 - sum * x * x / (2 * k * (2 * k + 1));
  return -x * x * x / 6 * sum;
}

double atanmx(double x) {
  const double z = x / (1 + std::hypot(1, x)), z2 = z * z;  // atan(x) = 2 atan(z), 2 z - x = -x z^2
  if (!(z2 < 0.1)) return std::atan(x) - x;
  double sum = 0;
  for (int k = 20; k >= 0; --k) sum = 1.0 / (2 * k + 3) - sum * z2;
  return -2 * z * z2 * sum - x * z2;
}

}  // namespace

const char* name_of(Call call) {
  static const char* const names[] = {"log",    "exp", "log1p", "expm1", "log1pmx", "expm1mx", "sinmx",
                                      "atanmx", "sin", "cos",   "tan",   "asin",    "acos",    "atan",
                                      "atan2",  "pow", "abs",   "min",   "max",     "select",  "keep"};
  return names[static_cast<int>(call)];
}

double evaluate(Call call, const std::vector<double>& a) {
  switch (call) {
    case Call::log:
      return std::log(a[0]);
    case Call::exp:
      return std::exp(a[0]);
    case Call::log1p:
      return std::log1p(a[0]);
    case Call::expm1:
      return std::expm1(a[0]);
    case Call::log1pmx:
      return log1pmx(a[0]);
    case Call::expm1mx:
      return expm1mx(a[0]);
    case Call::sinmx:
      return sinmx(a[0]);
    case Call::atanmx:
      return atanmx(a[0]);
    case Call::sin:
      return std::sin(a[0]);
    case Call::cos:
      return std::cos(a[0]);
    case Call::tan:
      return std::tan(a[0]);
    case Call::asin:
      return std::asin(a[0]);
    case Call::acos:
      return std::acos(a[0]);
    case Call::atan:
      return std::atan(a[0]);
    case Call::atan2:
      return std::atan2(a[0], a[1]);
    case Call::pow:
      return std::pow(a[0], a[1]);
    case Call::abs:
      return std::abs(a[0]);
    case Call::min:
      return std::min(a[0], a[1]);
    case Call::max:
      return std::max(a[0], a[1]);
    case Call::select:
      return a[0] > 0 ? a[1] : a[2];
    case Call::keep:
      return a[0];
  }
  throw std::logic_error("unknown call");
}

NodeId Graph::intern(Node node) {
  std::uint64_t h = hash_of(node);
  std::vector<NodeId>& bucket = by_hash_[h];
  for (NodeId id : bucket)
    if (same((*this)[id], node)) return id;
  nodes_.push_back(std::move(node));
  bucket.push_back(size() - 1);
  return size() - 1;
}

NodeId Graph::constant(double value) {
  Node n;
  n.constant = value == 0 ? 0 : value;  // one zero
  return intern(std::move(n));
}

NodeId Graph::input(Source source, int index) {
  Node n;
  n.kind = Node::Kind::input;
  n.source = source;
  n.index = index;
  return intern(std::move(n));
}

Term Graph::unscaled(NodeId id) const {
  const Node& n = (*this)[id];
  if (n.kind == Node::Kind::sum && n.terms.size() == 1 && n.constant == 0) return n.terms[0];
  return {1, id};
}

NodeId Graph::sum(double constant_term, std::vector<Term> terms) {
  std::vector<Term> flat;
  for (const Term& t : terms) {
    if (is_constant(t.node)) {
      constant_term += t.coefficient * (*this)[t.node].constant;
      continue;
    }
    Term core = unscaled(t.node);
    flat.push_back({t.coefficient * core.coefficient, core.node});
  }
  std::stable_sort(flat.begin(), flat.end(), [](const Term& a, const Term& b) { return a.node < b.node; });
  Node n;
  n.kind = Node::Kind::sum;
  for (const Term& t : flat) {
    if (!n.terms.empty() && n.terms.back().node == t.node)
      n.terms.back().coefficient += t.coefficient;
    else
      n.terms.push_back(t);
  }
  std::erase_if(n.terms, [](const Term& t) { return t.coefficient == 0; });
  if (n.terms.empty()) return constant(constant_term);
  n.constant = constant_term == 0 ? 0 : constant_term;
  if (n.terms.size() == 1 && n.constant == 0)
    return n.terms[0].coefficient == 1 ? n.terms[0].node : intern(std::move(n));
  if (n.terms[0].coefficient > 0) return intern(std::move(n));
  n.constant = n.constant == 0 ? 0 : -n.constant;
  for (Term& t : n.terms) t.coefficient = -t.coefficient;
  Node negated;
  negated.kind = Node::Kind::sum;
  negated.terms = {{-1, intern(std::move(n))}};
  return intern(std::move(negated));
}

NodeId Graph::product(double coefficient, std::vector<Factor> factors) {
  std::vector<Factor> flat;
  for (Factor f : factors) {
    reduce(f);
    if (f.num == 0) continue;
    Term core = unscaled(f.base);
    if (is_constant(f.base)) {
      double base = (*this)[f.base].constant;
      coefficient *= f.den == 1 ? std::pow(base, f.num) : std::pow(base, static_cast<double>(f.num) / f.den);
      continue;
    }
    // A negative coefficient stays under a root.
    if (f.den == 1 || core.coefficient > 0) {
      if (core.coefficient != 1)
        coefficient *= f.den == 1 ? std::pow(core.coefficient, f.num)
                                  : std::pow(core.coefficient, static_cast<double>(f.num) / f.den);
      f.base = core.node;
    }
    const Node& base = (*this)[f.base];
    // (y^a)^b = y^(ab) for integer b; for other b only when y^a already asks for y >= 0. (y^2)^(1/2) is |y|, not y.
    auto spliced = [&](const Factor& inner) { return f.den == 1 || inner.den > 1; };
    if (base.kind == Node::Kind::product && std::all_of(base.factors.begin(), base.factors.end(), spliced)) {
      for (const Factor& inner : base.factors) {
        Factor g{inner.base, inner.num * f.num, inner.den * f.den};
        reduce(g);
        flat.push_back(g);
      }
    } else {
      flat.push_back(f);
    }
  }
  if (coefficient == 0) return constant(0);
  std::stable_sort(flat.begin(), flat.end(), [](const Factor& a, const Factor& b) { return a.base < b.base; });
  Node n;
  n.kind = Node::Kind::product;
  for (const Factor& f : flat) {
    if (!n.factors.empty() && n.factors.back().base == f.base) {
      Factor& last = n.factors.back();
      last = {f.base, last.num * f.den + f.num * last.den, last.den * f.den};
      reduce(last);
    } else {
      n.factors.push_back(f);
    }
  }
  std::erase_if(n.factors, [](const Factor& f) { return f.num == 0; });
  if (n.factors.empty()) return constant(coefficient);
  NodeId id = n.factors.size() == 1 && n.factors[0].num == 1 && n.factors[0].den == 1 ? n.factors[0].base
                                                                                      : intern(std::move(n));
  return coefficient == 1 ? id : scale(coefficient, id);
}

NodeId Graph::divide(NodeId a, NodeId b) {
  if (is_constant(b)) {
    double divisor = (*this)[b].constant;
    if (is_constant(a)) return constant((*this)[a].constant / divisor);
    Term core = unscaled(a);
    return scale(core.coefficient / divisor, core.node);
  }
  return product(1, {{a}, {b, -1}});
}

NodeId Graph::call(Call call, std::vector<NodeId> arguments) {
  if (std::all_of(arguments.begin(), arguments.end(), [&](NodeId a) { return is_constant(a); })) {
    std::vector<double> values;
    for (NodeId a : arguments) values.push_back((*this)[a].constant);
    return constant(evaluate(call, values));
  }
  if (call == Call::select) {
    if (is_constant(arguments[0])) return (*this)[arguments[0]].constant > 0 ? arguments[1] : arguments[2];
    if (arguments[1] == arguments[2]) return arguments[1];
  }
  if ((call == Call::min || call == Call::max) && arguments[0] == arguments[1]) return arguments[0];
  Node n;
  n.kind = Node::Kind::call;
  n.call = call;
  n.arguments = std::move(arguments);
  return intern(std::move(n));
}

std::vector<NodeId> Graph::operands(NodeId id) const {
  const Node& n = (*this)[id];
  std::vector<NodeId> out;
  for (const Term& t : n.terms) out.push_back(t.node);
  for (const Factor& f : n.factors) out.push_back(f.base);
  out.insert(out.end(), n.arguments.begin(), n.arguments.end());
  return out;
}

void Graph::set_name(NodeId id, const std::string& name) {
  if (!is_constant(id) && unscaled(id).coefficient == 1) names_.try_emplace(id, name);
}

const std::string& Graph::name(NodeId id) const {
  static const std::string none;
  auto it = names_.find(id);
  return it == names_.end() ? none : it->second;
}

std::vector<NodeId> reachable(const Graph& graph, std::span<const NodeId> roots) {
  // Operands are always created before their users, so ascending numbers are an order of evaluation.
  std::vector<char> seen(static_cast<size_t>(graph.size()), 0);
  for (NodeId r : roots) seen[static_cast<size_t>(r)] = 1;
  for (NodeId id = graph.size() - 1; id >= 0; --id)
    if (seen[static_cast<size_t>(id)])
      for (NodeId o : graph.operands(id)) seen[static_cast<size_t>(o)] = 1;
  std::vector<NodeId> out;
  for (NodeId id = 0; id < graph.size(); ++id)
    if (seen[static_cast<size_t>(id)]) out.push_back(id);
  return out;
}

std::string to_string(const Graph& graph, std::span<const NodeId> roots) {
  static const char* const sources[] = {"param", "raw", "point", "q", "stretch", "negative"};
  std::string out;
  for (NodeId id : reachable(graph, roots)) {
    const Node& n = graph[id];
    std::string line;
    switch (n.kind) {
      case Node::Kind::constant:
        line = fmt::format("{}", n.constant);
        break;
      case Node::Kind::input:
        line = fmt::format("{}[{}]", sources[static_cast<int>(n.source)], n.index);
        break;
      case Node::Kind::sum:
        if (n.constant != 0) line = fmt::format("{}", n.constant);
        for (const Term& t : n.terms) line += fmt::format("{}{}*%{}", line.empty() ? "" : " + ", t.coefficient, t.node);
        break;
      case Node::Kind::product:
        for (const Factor& f : n.factors) {
          if (!line.empty()) line += " * ";
          line += f.den != 1   ? fmt::format("%{}^({}/{})", f.base, f.num, f.den)
                  : f.num != 1 ? fmt::format("%{}^{}", f.base, f.num)
                               : fmt::format("%{}", f.base);
        }
        break;
      case Node::Kind::call:
        line = name_of(n.call);
        for (size_t i = 0; i < n.arguments.size(); ++i) line += fmt::format("{}%{}", i ? ", " : "(", n.arguments[i]);
        line += ")";
        break;
    }
    out += fmt::format("%{} = {}{}{}\n", id, line, graph.name(id).empty() ? "" : "  # ", graph.name(id));
  }
  out += "roots";
  for (NodeId r : roots) out += fmt::format(" %{}", r);
  return out + "\n";
}

void verify(const Graph& graph) {
  for (NodeId id = 0; id < graph.size(); ++id) {
    const Node& n = graph[id];
    auto fail = [&](const char* what) { throw std::logic_error(fmt::format("graph node %{}: {}", id, what)); };
    for (NodeId o : graph.operands(id))
      if (o >= id) fail("operand created after its user");
    if (n.kind == Node::Kind::sum) {
      if (n.terms.empty()) fail("sum without terms");
      bool scaled = n.terms.size() == 1 && n.constant == 0;
      if (scaled ? n.terms[0].coefficient == 1 : !(n.terms[0].coefficient > 0)) fail("sum not in normal form");
      for (size_t i = 0; i < n.terms.size(); ++i) {
        if (n.terms[i].coefficient == 0 || graph.is_constant(n.terms[i].node)) fail("sum with an empty term");
        if (i > 0 && n.terms[i - 1].node >= n.terms[i].node) fail("sum not sorted");
      }
    }
    for (size_t i = 0; i < n.factors.size(); ++i) {
      const Factor& f = n.factors[i];
      if (f.num == 0 || f.den <= 0 || std::gcd(std::abs(f.num), f.den) != 1) fail("exponent not in lowest terms");
      if (graph.is_constant(f.base)) fail("product with a constant");
      if (i > 0 && n.factors[i - 1].base >= f.base) fail("product not sorted");
    }
  }
}

}  // namespace ergon
