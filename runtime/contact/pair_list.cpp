#include "runtime/contact/pair_list.h"

#include <omp.h>

#include <algorithm>

#include "runtime/lanes/lanes.h"

namespace ergon {

namespace {

constexpr size_t kSerial = 256;  // pairs of leaves: fewer are not worth waking other threads

}  // namespace

void PairList::clear() {
  leaves_.clear();
  segments_.clear();
}

void PairList::add(int object_a, int object_b, const Shift& shift) {
  const BoxTree::Node *a = a_->root(object_a), *b = b_->root(object_b);
  if (a == nullptr || b == nullptr) return;
  BoxTree::meet(a, b, shift.lower.data(), shift.upper.data(), leaves_);
  if (leaves_.size() > (segments_.empty() ? 0 : segments_.back().end)) segments_.push_back({shift, leaves_.size()});
}

void PairList::write_range(size_t first, size_t last, size_t thread) {
  const lanes::OverlapOperations& operations = lanes::overlap_operations(lanes::best_lanes());
  Found& found = found_[thread];
  found.count = 0;
  auto segment = std::upper_bound(segments_.begin(), segments_.end(), first,
                                  [](size_t at, const Segment& each) { return at < each.end; });
  while (first < last) {
    if (first == segment->end) ++segment;
    lanes::OverlapTask task{};
    task.a = a_->leaves();
    task.b = b_->leaves();
    task.corners_a = a_->corners();
    task.corners_b = b_->corners();
    task.same = a_ == b_;
    std::copy(segment->shift.lower.begin(), segment->shift.lower.end(), task.shift_lower);
    std::copy(segment->shift.upper.begin(), segment->shift.upper.end(), task.shift_upper);
    const size_t end = std::min(last, segment->end);
    const long before = found.count;
    while (first < end) {
      if (static_cast<long>(found.pairs.size()) < found.count + lanes::kMostOverlaps) {
        found.pairs.resize(2 * found.pairs.size() + 16 * static_cast<size_t>(lanes::kMostOverlaps));
      }
      first +=
          static_cast<size_t>(operations.overlaps(task, leaves_.data() + first, static_cast<long>(end - first),
                                                  reinterpret_cast<lanes::IdPair*>(found.pairs.data() + found.count),
                                                  static_cast<long>(found.pairs.size()) - found.count, &found.count));
    }
    if (filter_)
      found.count = before + filter_(found.pairs.data() + before, found.count - before, segment->shift.length);
  }
}

void PairList::write(std::vector<std::array<int, 2>>& out) {
  static_assert(sizeof(lanes::IdPair) == sizeof(std::array<int, 2>));
  const size_t count = leaves_.size();
  found_.resize(std::max(found_.size(), static_cast<size_t>(omp_get_max_threads())));
  for (Found& each : found_) each.count = 0;
  if (count > 0) {
#pragma omp parallel if (count > kSerial)
    {
      const auto thread = static_cast<size_t>(omp_get_thread_num()),
                 threads = static_cast<size_t>(omp_get_num_threads());
      write_range(count * thread / threads, count * (thread + 1) / threads, thread);
    }
  }
  out.clear();
  for (const Found& each : found_) out.insert(out.end(), each.pairs.begin(), each.pairs.begin() + each.count);
}

}  // namespace ergon
