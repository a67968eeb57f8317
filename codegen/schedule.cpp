#include "codegen/schedule.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "codegen/share.h"

namespace ergon {
namespace {

class Scheduler {
 public:
  explicit Scheduler(Module& module) : g_(module.graph), roots_(module.roots()) {}

  void prepare() {
    find_lifetimes();
    split_products();
    shared_ = share_pairs(lists_, static_cast<int>(atoms_.size()));
    values_.assign(static_cast<size_t>(g_.size()), -1);
    atom_values_.assign(atoms_.size() + shared_.size(), -1);
  }

  int value(NodeId id) {
    Term core = g_.unscaled(id);
    if (core.node != id) return p_.multiply(p_.constant(core.coefficient), value(core.node));
    if (static_cast<size_t>(id) >= values_.size()) values_.resize(static_cast<size_t>(g_.size()), -1);
    if (values_[static_cast<size_t>(id)] >= 0) return values_[static_cast<size_t>(id)];
    const Node n = g_[id];
    int v = -1;
    switch (n.kind) {
      case Node::Kind::constant:
        v = p_.constant(n.constant);
        break;
      case Node::Kind::input:
        v = p_.input(n.source, n.index);
        break;
      case Node::Kind::sum:
        v = sum_value(id);
        break;
      case Node::Kind::product:
        v = list_value(lists_[list_of_.at(id)]);
        break;
      case Node::Kind::call: {
        std::vector<int> a;
        for (NodeId o : n.arguments) a.push_back(value(o));
        v = n.call == Call::keep ? a[0] : p_.call(n.call, a[0], a.size() > 1 ? a[1] : -1, a.size() > 2 ? a[2] : -1);
        break;
      }
    }
    values_[static_cast<size_t>(id)] = v;
    if (!g_.name(id).empty()) p_.set_name(v, g_.name(id));
    return v;
  }

  std::vector<int> values(const std::vector<NodeId>& ids) {
    std::vector<int> out;
    for (NodeId id : ids) out.push_back(value(id));
    return out;
  }

  Program take() { return std::move(p_); }

 private:
  // A factor of a product as one number: the base itself, its reciprocal, a root, or a general power.
  enum class Form { plain, reciprocal, root, reciprocal_root, power };
  struct Atom {
    NodeId base;
    Form form;
    int num = 1, den = 1;
    auto key() const { return std::tuple(base, form, num, den); }
  };

  Lifetime lifetime(NodeId id) {
    while (lifetimes_.size() < static_cast<size_t>(g_.size())) {
      NodeId next = static_cast<NodeId>(lifetimes_.size());
      const Node& n = g_[next];
      Lifetime l = Lifetime::constant;
      if (n.kind == Node::Kind::input)
        l = n.source == Source::param ? Lifetime::uniform
            : n.source == Source::raw ? Lifetime::element
                                      : Lifetime::state;
      for (NodeId o : g_.operands(next)) l = std::max(l, lifetimes_[static_cast<size_t>(o)]);
      lifetimes_.push_back(l);
    }
    return lifetimes_[static_cast<size_t>(id)];
  }

  void find_lifetimes() {
    if (g_.size() > 0) lifetime(g_.size() - 1);
  }

  // Sums are cut so that terms of shorter work (longer lifetime) are a sum of their own. Part of split_products, since
  // both make new nodes whose products need atoms.
  NodeId hoisted_terms(NodeId id) {
    const Node n = g_[id];
    Lifetime own = lifetime(id);
    std::vector<Term> early;
    for (const Term& t : n.terms)
      if (lifetime(t.node) < own) early.push_back(t);
    if (early.size() + (n.constant != 0 ? 1 : 0) < 2 || early.empty() || early.size() == n.terms.size()) return -1;
    return g_.sum(n.constant, early);
  }

  void split_products() {
    std::vector<NodeId> work = reachable(g_, roots_);
    std::set<NodeId> seen(work.begin(), work.end());
    auto visit = [&](NodeId id) {
      for (NodeId r : reachable(g_, std::vector<NodeId>{id}))
        if (seen.insert(r).second) work.push_back(r);
    };
    for (size_t i = 0; i < work.size(); ++i) {
      NodeId id = work[i];
      if (g_[id].kind == Node::Kind::sum && g_[id].terms.size() > 1) {
        NodeId early = hoisted_terms(id);
        if (early >= 0) early_[id] = early, visit(early);
      }
      if (g_[id].kind == Node::Kind::product) {
        std::vector<Factor> early, own;
        for (const Factor& f : g_[id].factors) (lifetime(f.base) < lifetime(id) ? early : own).push_back(f);
        if (early.size() > 1) {
          NodeId group = g_.product(1, early);
          visit(group);
          early = {{group}};
        }
        own.insert(own.begin(), early.begin(), early.end());
        factors_[id] = own;
      }
    }
    std::set<NodeId> rooted;  // bases of which a reciprocal root is needed: 1/x is then its square
    for (const auto& [id, factors] : factors_)
      for (const Factor& f : factors)
        if (f.den == 2 && f.num < 0) rooted.insert(f.base);
    rooted_ = rooted;
    for (const auto& [id, factors] : factors_) {
      std::vector<int> list;
      for (const Factor& f : factors) append_atoms(f, list);
      std::sort(list.begin(), list.end());
      list_of_[id] = lists_.size();
      lists_.push_back(std::move(list));
    }
  }

  int atom(const Atom& a) {
    auto [it, is_new] = atom_numbers_.try_emplace(a.key(), static_cast<int>(atoms_.size()));
    if (is_new) atoms_.push_back(a);
    return it->second;
  }

  void append_atoms(const Factor& f, std::vector<int>& list) {
    int size = std::abs(f.num);
    if (f.den > 2 || size > 16) {
      list.push_back(atom({f.base, Form::power, f.num, f.den}));
      return;
    }
    int whole = f.den == 1 ? size : (size - 1) / 2;
    Form one = f.num > 0 ? Form::plain : Form::reciprocal;
    if (f.den == 2) list.push_back(atom({f.base, f.num > 0 ? Form::root : Form::reciprocal_root}));
    list.insert(list.end(), static_cast<size_t>(whole), whole > 0 ? atom({f.base, one}) : 0);
  }

  int atom_value(int number) {
    int& known = atom_values_[static_cast<size_t>(number)];
    if (known >= 0) return known;
    int v = -1;
    if (static_cast<size_t>(number) >= atoms_.size()) {
      auto [a, b] = shared_[static_cast<size_t>(number) - atoms_.size()];
      v = p_.multiply(atom_value(a), atom_value(b));
    } else {
      const Atom a = atoms_[static_cast<size_t>(number)];
      int base = value(a.base);
      int one = p_.constant(1);
      switch (a.form) {
        case Form::plain:
          v = base;
          break;
        case Form::root:
          v = p_.sqrt(base);
          break;
        case Form::reciprocal_root:
          v = p_.divide(one, p_.sqrt(base));
          break;
        case Form::reciprocal:
          if (rooted_.count(a.base)) {
            int r = p_.divide(one, p_.sqrt(base));
            v = p_.multiply(r, r);
          } else {
            v = p_.divide(one, base);
          }
          break;
        case Form::power:
          v = p_.call(Call::pow, base, p_.constant(static_cast<double>(a.num) / a.den));
          break;
      }
    }
    return atom_values_[static_cast<size_t>(number)] = v;
  }

  int list_value(const std::vector<int>& list) {
    int v = atom_value(list[0]);
    for (size_t i = 1; i < list.size(); ++i) v = p_.multiply(v, atom_value(list[i]));
    return v;
  }

  // Terms of equal |coefficient| are added first and scaled once.
  int sum_value(NodeId id) {
    const Node n = g_[id];
    double constant = n.constant;
    std::vector<std::pair<double, int>> terms;
    auto it = early_.find(id);
    if (it != early_.end()) {
      constant = 0;
      Term early = g_.unscaled(it->second);
      terms.push_back({early.coefficient, value(early.node)});
    }
    for (const Term& t : n.terms)
      if (it == early_.end() || lifetime(t.node) == lifetime(id)) terms.push_back({t.coefficient, value(t.node)});

    std::vector<double> sizes = {1};
    for (const auto& [c, v] : terms)
      if (std::find(sizes.begin(), sizes.end(), std::abs(c)) == sizes.end()) sizes.push_back(std::abs(c));
    int total = constant > 0 ? p_.constant(constant) : -1;
    int negative = constant < 0 ? p_.constant(-constant) : -1;
    auto plus = [&](int& to, int v) { to = to < 0 ? v : p_.add(to, v); };
    for (double size : sizes) {
      int up = -1, down = -1;
      for (const auto& [c, v] : terms)
        if (std::abs(c) == size) plus(c > 0 ? up : down, v);
      if (up < 0 && down < 0) continue;
      int both = up < 0 ? down : down < 0 ? up : p_.subtract(up, down);
      if (size != 1) both = p_.multiply(p_.constant(size), both);
      plus(up < 0 ? negative : total, both);
    }
    if (total < 0) return p_.negate(negative);
    return negative < 0 ? total : p_.subtract(total, negative);
  }

  Graph& g_;
  std::vector<NodeId> roots_;
  Program p_;
  std::vector<Lifetime> lifetimes_;
  std::map<NodeId, NodeId> early_;                 // sum -> its part of longer lifetime
  std::map<NodeId, std::vector<Factor>> factors_;  // product -> factors, those of longer lifetime as one
  std::set<NodeId> rooted_;
  std::vector<Atom> atoms_;
  std::map<std::tuple<NodeId, Form, int, int>, int> atom_numbers_;
  std::map<NodeId, size_t> list_of_;
  std::vector<std::vector<int>> lists_;
  std::vector<std::pair<int, int>> shared_;
  std::vector<int> values_, atom_values_;
};

}  // namespace

Schedule schedule(Module& module) {
  Scheduler scheduler(module);
  scheduler.prepare();
  Schedule out;
  out.value = scheduler.value(module.value);
  out.active = scheduler.values(module.active);
  out.require = scheduler.values(module.require);
  out.update = scheduler.values(module.update);
  out.gradient = scheduler.values(module.gradient);
  out.hessian = scheduler.values(module.hessian);
  out.principal = scheduler.values(module.principal);
  out.projected = scheduler.values(module.projected);
  if (module.changed >= 0) out.changed = scheduler.value(module.changed);
  if (module.near >= 0) {
    out.near = scheduler.value(module.near);
    out.far_value = scheduler.value(module.far.value);
    out.far_gradient = scheduler.values(module.far.gradient);
    out.far_hessian = scheduler.values(module.far.hessian);
  }
  out.program = scheduler.take();
  return out;
}

}  // namespace ergon
