#include "codegen/slots.h"

namespace ergon {

Slots assign_slots(const Schedule& s) {
  const Program& p = s.program;
  std::vector<int> roots = {s.value};
  if (s.near >= 0) roots.insert(roots.end(), {s.near, s.far_value});
  if (s.changed >= 0) roots.push_back(s.changed);
  for (const auto* list : {&s.active, &s.require, &s.update, &s.gradient, &s.hessian, &s.principal, &s.projected,
                           &s.far_gradient, &s.far_hessian})
    roots.insert(roots.end(), list->begin(), list->end());

  // The shortest lifetime among the users of each value; entry points run at Lifetime::state.
  std::vector<Lifetime> user(static_cast<size_t>(p.size()), Lifetime::constant);
  for (int r : roots) user[static_cast<size_t>(r)] = Lifetime::state;
  for (int i : needed(p, roots, {}))
    for (int o : {p[i].a, p[i].b, p[i].c})
      if (o >= 0) user[static_cast<size_t>(o)] = std::max(user[static_cast<size_t>(o)], p[i].lifetime);

  Slots out;
  out.uniform.assign(static_cast<size_t>(p.size()), -1);
  out.element.assign(static_cast<size_t>(p.size()), -1);
  for (int i = 0; i < p.size(); ++i) {
    size_t k = static_cast<size_t>(i);
    if (user[k] <= p[i].lifetime) continue;
    if (p[i].lifetime == Lifetime::uniform) {
      out.uniform[k] = static_cast<int>(out.uniforms.size());
      out.uniforms.push_back(i);
    } else if (p[i].lifetime == Lifetime::element) {
      out.element[k] = static_cast<int>(out.elements.size());
      out.elements.push_back(i);
    }
  }
  return out;
}

std::vector<int> needed(const Program& p, const std::vector<int>& roots,
                        const std::vector<const std::vector<int>*>& given) {
  std::vector<int> order;
  std::vector<char> done(static_cast<size_t>(p.size()), 0);
  std::vector<std::pair<int, int>> stack;
  for (int root : roots) {
    stack.push_back({root, 0});
    while (!stack.empty()) {
      auto& [i, next] = stack.back();
      if (done[static_cast<size_t>(i)]) {
        stack.pop_back();
        continue;
      }
      bool stop = false;
      for (const auto* slots : given) stop = stop || (*slots)[static_cast<size_t>(i)] >= 0;
      int operands[] = {p[i].a, p[i].b, p[i].c};
      while (!stop && next < 3 && operands[next] < 0) ++next;
      if (stop || next == 3) {
        done[static_cast<size_t>(i)] = 1;
        order.push_back(i);
        stack.pop_back();
      } else {
        stack.push_back({operands[next++], 0});
      }
    }
  }
  return order;
}

}  // namespace ergon
