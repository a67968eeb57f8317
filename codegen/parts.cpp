#include "codegen/parts.h"

#include <algorithm>
#include <numeric>

namespace ergon {

std::vector<Entry> hessian_entries(int q_vectors, const std::vector<int>& parts) {
  std::vector<int> part_of = parts;
  if (part_of.empty()) part_of.assign(static_cast<size_t>(q_vectors), 0);
  std::vector<Entry> entries;
  for (int part = 0; part < q_vectors; ++part)
    for (int i = 0; i < 3 * q_vectors; ++i)
      for (int j = 0; j <= i; ++j)
        if (part_of[static_cast<size_t>(i / 3)] == part && part_of[static_cast<size_t>(j / 3)] == part)
          entries.push_back({i, j});
  return entries;
}

std::vector<Entry> hessian_entries(const ErgonKernel& kernel) {
  if (kernel.parts == nullptr) return hessian_entries(kernel.q_vectors, {});
  return hessian_entries(kernel.q_vectors, std::vector<int>(kernel.parts, kernel.parts + kernel.q_vectors));
}

void find_parts(Module& m) {
  if (m.stretches || m.constant_hessian || m.zero_hessian || !m.principal.empty() || m.changed >= 0) return;
  const std::vector<Entry> all = hessian_entries(m.q_vectors, {});
  std::vector<int> joined(static_cast<size_t>(m.q_vectors));  // to the first vector of the same part
  std::iota(joined.begin(), joined.end(), 0);
  std::vector<char> used(joined.size(), 0);
  for (const std::vector<NodeId>* hessian : {&m.hessian, &m.far.hessian}) {
    for (size_t k = 0; k < hessian->size(); ++k) {
      if (m.graph.is_constant((*hessian)[k], 0)) continue;
      const auto i = static_cast<size_t>(all[k].row / 3), j = static_cast<size_t>(all[k].column / 3);
      used[i] = used[j] = 1;
      const int low = std::min(joined[i], joined[j]), high = std::max(joined[i], joined[j]);
      std::replace(joined.begin(), joined.end(), high, low);
    }
  }
  std::vector<int> parts(joined.size(), -1);
  int count = 0;
  for (size_t i = 0; i < parts.size(); ++i) {
    if (!used[i]) continue;
    const auto first = static_cast<size_t>(joined[i]);
    parts[i] = first == i ? count++ : parts[first];
  }
  if (std::all_of(parts.begin(), parts.end(), [](int part) { return part == 0; })) return;
  for (std::vector<NodeId>* hessian : {&m.hessian, &m.far.hessian}) {
    if (hessian->empty()) continue;
    std::vector<NodeId> kept;
    for (const Entry& e : hessian_entries(m.q_vectors, parts))
      kept.push_back((*hessian)[static_cast<size_t>(e.row * (e.row + 1) / 2 + e.column)]);
    *hessian = std::move(kept);
  }
  m.parts = std::move(parts);
}

}  // namespace ergon
