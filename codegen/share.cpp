#include "codegen/share.h"

#include <algorithm>
#include <map>
#include <queue>
#include <set>

namespace ergon {
namespace {

using Pair = std::pair<int, int>;

// The distinct pairs in one product.
std::set<Pair> pairs_in(const std::vector<int>& list) {
  std::set<Pair> out;
  for (size_t i = 0; i < list.size(); ++i)
    for (size_t j = i + 1; j < list.size(); ++j) out.insert(std::minmax(list[i], list[j]));
  return out;
}

// Replaces the pair by `atom` as often as it occurs.
void replace(std::vector<int>& list, Pair pair, int atom) {
  for (;;) {
    auto first = std::find(list.begin(), list.end(), pair.first);
    if (first == list.end()) return;
    auto second = std::find(pair.first == pair.second ? first + 1 : list.begin(), list.end(), pair.second);
    if (second == list.end()) return;
    *first = atom;
    list.erase(second);
  }
}

}  // namespace

std::vector<Pair> share_pairs(std::vector<std::vector<int>>& lists, int atoms) {
  std::map<Pair, std::set<int>> where;
  struct Candidate {
    size_t count;
    Pair pair;
    bool operator<(const Candidate& o) const { return count != o.count ? count < o.count : pair > o.pair; }
  };
  std::priority_queue<Candidate> queue;
  auto enter = [&](int list) {
    for (Pair p : pairs_in(lists[static_cast<size_t>(list)])) {
      auto& places = where[p];
      places.insert(list);
      if (places.size() > 1) queue.push({places.size(), p});
    }
  };
  for (size_t l = 0; l < lists.size(); ++l) enter(static_cast<int>(l));

  std::vector<Pair> taken;
  while (!queue.empty()) {
    Candidate best = queue.top();
    queue.pop();
    size_t count = where[best.pair].size();
    if (count != best.count) {  // out of date: others took factors from these products
      if (count > 1 && count < best.count) queue.push({count, best.pair});
      continue;
    }
    int atom = atoms + static_cast<int>(taken.size());
    taken.push_back(best.pair);
    std::set<int> places = where[best.pair];
    for (int l : places) {
      for (Pair p : pairs_in(lists[static_cast<size_t>(l)])) where[p].erase(l);
      replace(lists[static_cast<size_t>(l)], best.pair, atom);
    }
    for (int l : places) enter(l);
  }
  return taken;
}

}  // namespace ergon
