#include "runtime/solver/linear_solver.h"

#include <cholmod.h>
#include <dlfcn.h>
#include <omp.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "runtime/error.h"

namespace ergon {

namespace {

// Below this many operations per factorisation the threads of the BLAS cost more than they bring: its workers spin for
// a while after each call.
constexpr double flops_worth_threads = 1e9;

// While it lives, CHOLMOD keeps to the calling thread, and so does OpenBLAS unless `threaded` (other BLAS libraries are
// left as they are). CHOLMOD would open a team of four for each pair of supernodes, however few the cores: two thirds
// of the processor time at 2,000 unknowns, a third of the time at 26,000.
class Threads {
 public:
  explicit Threads(bool threaded) : levels_(omp_get_max_active_levels()) {
    omp_set_max_active_levels(0);
    if (threaded || !set_threads() || !get_threads()) return;
    blas_threads_ = get_threads()();
    if (blas_threads_ > 1) set_threads()(1);
  }
  ~Threads() {
    omp_set_max_active_levels(levels_);
    if (blas_threads_ > 1) set_threads()(blas_threads_);
  }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

 private:
  using Set = void (*)(int);
  using Get = int (*)();
  static Set set_threads() {
    static const Set set = reinterpret_cast<Set>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
    return set;
  }
  static Get get_threads() {
    static const Get get = reinterpret_cast<Get>(dlsym(RTLD_DEFAULT, "openblas_get_num_threads"));
    return get;
  }
  int levels_;
  int blas_threads_ = 0;
};

// The matrix's pattern as a graph of block rows: ordering it finds the same fill at a ninth of the entries.
struct BlockGraph {
  std::vector<int> start;
  std::vector<int> row;

  explicit BlockGraph(const BlockMatrix& matrix) {
    start.reserve(static_cast<size_t>(matrix.block_rows()) + 1);
    row.reserve(matrix.blocks());
    start.push_back(0);
    for (int block = 0; block < matrix.block_rows(); ++block) {
      const auto column = static_cast<size_t>(3 * block);
      for (int entry = matrix.column_start()[column]; entry < matrix.column_start()[column + 1]; entry += 3) {
        row.push_back(matrix.row_index()[static_cast<size_t>(entry)] / 3);
      }
      start.push_back(static_cast<int>(row.size()));
    }
  }
};

cholmod_sparse lower_triangle(int rows, std::vector<int>& start, std::vector<int>& row, double* values) {
  cholmod_sparse a{};
  a.nrow = a.ncol = static_cast<size_t>(rows);
  a.nzmax = row.size();
  a.p = start.data();
  a.i = row.data();
  a.x = values;
  a.stype = -1;
  a.itype = CHOLMOD_INT;
  a.xtype = values ? CHOLMOD_REAL : CHOLMOD_PATTERN;
  a.dtype = CHOLMOD_DOUBLE;
  a.sorted = 1;
  a.packed = 1;
  return a;
}

// CHOLMOD's structs are not const-correct; it reads the matrix only.
cholmod_sparse view(const BlockMatrix& matrix) {
  return lower_triangle(matrix.rows(), const_cast<std::vector<int>&>(matrix.column_start()),
                        const_cast<std::vector<int>&>(matrix.row_index()), const_cast<double*>(matrix.values().data()));
}

// Nested dissection of graphs smaller than this gains nothing over minimum degree.
constexpr int smallest_dissected = 100;

// Ordering takes as long as this many operations of a factorisation for each block row: measured on two boxes of 13^3
// vertices in contact, 27 ms of 40 ms that an analysis takes and of 150 ms that a factorisation takes.
constexpr double flops_to_order = 5e4;

}  // namespace

struct LinearSolver::Impl {
  Ordering ordering;
  cholmod_common common;
  cholmod_factor* factor = nullptr;
  cholmod_dense* solution = nullptr;  // workspace of solve, kept between calls
  cholmod_dense* work_y = nullptr;
  cholmod_dense* work_e = nullptr;
  bool factored = false;
  bool analysed = false;
  unsigned long pattern = 0;
  int rows = 0;
  long analyses = 0;
  long orderings = 0;
  long factorisations = 0;
  double entries = 0;
  double flops = 0;
  std::vector<int> order;           // of block rows; empty: none yet
  double ordered_flops = 0;         // when that order was found
  bool prefers_dissection = false;  // it was the better one

  explicit Impl(Ordering o) : ordering(o) {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.quick_return_if_not_posdef = 1;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_GIVEN;
    common.postorder = 1;
  }
  ~Impl() {
    cholmod_free_factor(&factor, &common);
    cholmod_free_dense(&solution, &common);
    cholmod_free_dense(&work_y, &common);
    cholmod_free_dense(&work_e, &common);
    cholmod_finish(&common);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void check_memory(const char* what) {
    if (common.status == CHOLMOD_OUT_OF_MEMORY || common.status == CHOLMOD_TOO_LARGE) {
      throw InputError("not enough memory to " + std::string(what) + " a matrix of " + std::to_string(rows) +
                       " unknowns; use a coarser mesh");
    }
    if (common.status < CHOLMOD_OK) {
      throw std::logic_error("CHOLMOD cannot " + std::string(what) + " this matrix: status " +
                             std::to_string(common.status));
    }
  }

  std::vector<int> find_order(const BlockMatrix& matrix, bool dissection) {
    BlockGraph graph(matrix);
    cholmod_sparse blocks = lower_triangle(matrix.block_rows(), graph.start, graph.row, nullptr);
    std::vector<int> found(static_cast<size_t>(matrix.block_rows()));
    const bool ordered = dissection ? cholmod_metis(&blocks, nullptr, 0, 1, found.data(), &common)
                                    : cholmod_amd(&blocks, nullptr, 0, found.data(), &common);
    if (!ordered && dissection && common.status == CHOLMOD_NOT_INSTALLED) return find_order(matrix, false);
    check_memory("order");
    return found;
  }

  // Analyses with this ordering of the block rows. Keeps what is there instead if that needs fewer operations.
  bool analyse_ordered(const BlockMatrix& matrix, const std::vector<int>& block_order) {
    std::vector<int> scalar_order(3 * block_order.size());
    for (size_t i = 0; i < block_order.size(); ++i) {
      for (int c = 0; c < 3; ++c) scalar_order[3 * i + static_cast<size_t>(c)] = 3 * block_order[i] + c;
    }
    cholmod_sparse a = view(matrix);
    cholmod_factor* candidate = cholmod_analyze_p(&a, scalar_order.data(), nullptr, 0, &common);
    check_memory("analyse");
    if (factor && common.fl >= flops) {
      cholmod_free_factor(&candidate, &common);
      return false;
    }
    cholmod_free_factor(&factor, &common);
    factor = candidate;
    entries = common.lnz;
    flops = common.fl;
    return true;
  }

  // Takes the ordering of the last pattern for this one unless its factor needs so many operations more that finding
  // another order is likely to be quicker.
  bool keeps_order(const BlockMatrix& matrix) {
    if (order.size() != static_cast<size_t>(matrix.block_rows())) return false;
    analyse_ordered(matrix, order);
    if (flops <= ordered_flops + flops_to_order * matrix.block_rows()) return true;
    cholmod_free_factor(&factor, &common);
    return false;
  }

  void order_anew(const BlockMatrix& matrix) {
    const bool choose = ordering == Ordering::automatic && matrix.block_rows() >= smallest_dissected;
    const bool both = choose && order.size() != static_cast<size_t>(matrix.block_rows());
    const bool first = choose ? !both && prefers_dissection : ordering == Ordering::nested_dissection;
    order = find_order(matrix, first);
    analyse_ordered(matrix, order);
    prefers_dissection = first;
    if (both) {
      std::vector<int> other = find_order(matrix, true);
      prefers_dissection = analyse_ordered(matrix, other);
      if (prefers_dissection) order = std::move(other);
    }
    ordered_flops = flops;
    ++orderings;
  }
};

LinearSolver::LinearSolver(Ordering ordering) : impl_(std::make_unique<Impl>(ordering)) {}
LinearSolver::~LinearSolver() = default;
LinearSolver::LinearSolver(LinearSolver&&) noexcept = default;
LinearSolver& LinearSolver::operator=(LinearSolver&&) noexcept = default;

void LinearSolver::analyse(const BlockMatrix& matrix) {
  Impl& s = *impl_;
  if (s.analysed && s.pattern == matrix.pattern_id()) return;
  s.factored = s.analysed = false;
  cholmod_free_factor(&s.factor, &s.common);
  s.rows = matrix.rows();
  if (s.rows > 0 && !s.keeps_order(matrix)) s.order_anew(matrix);
  s.pattern = matrix.pattern_id();
  s.analysed = true;
  ++s.analyses;
}

std::optional<int> LinearSolver::factor(const BlockMatrix& matrix, double shift) {
  analyse(matrix);
  Impl& s = *impl_;
  s.factored = false;
  ++s.factorisations;
  if (s.rows > 0) {
    const Threads threads(s.flops >= flops_worth_threads);
    cholmod_sparse a = view(matrix);
    double beta[2] = {shift, 0};
    cholmod_factorize_p(&a, beta, nullptr, 0, s.factor, &s.common);
    s.check_memory("factor");
    if (s.factor->minor < static_cast<size_t>(s.rows)) {
      return static_cast<const int*>(s.factor->Perm)[s.factor->minor];
    }
  }
  s.factored = true;
  return std::nullopt;
}

void LinearSolver::solve(const Eigen::VectorXd& right_side, Eigen::VectorXd& solution) {
  Impl& s = *impl_;
  if (!s.factored) throw std::logic_error("LinearSolver::solve: there is no factor");
  if (right_side.size() != s.rows) throw std::logic_error("LinearSolver::solve: right side of another size");
  solution.resize(s.rows);
  if (s.rows == 0) return;
  const Threads threads(s.flops >= flops_worth_threads);
  cholmod_dense b{};
  b.nrow = b.d = b.nzmax = static_cast<size_t>(s.rows);
  b.ncol = 1;
  b.x = const_cast<double*>(right_side.data());
  b.xtype = CHOLMOD_REAL;
  b.dtype = CHOLMOD_DOUBLE;
  cholmod_solve2(CHOLMOD_A, s.factor, &b, nullptr, &s.solution, nullptr, &s.work_y, &s.work_e, &s.common);
  s.check_memory("solve");
  const auto* values = static_cast<const double*>(s.solution->x);
  std::copy(values, values + s.rows, solution.data());
}

long LinearSolver::analyses() const { return impl_->analyses; }
long LinearSolver::orderings() const { return impl_->orderings; }
long LinearSolver::factorisations() const { return impl_->factorisations; }
double LinearSolver::factor_entries() const { return impl_->entries; }
double LinearSolver::factor_flops() const { return impl_->flops; }

}  // namespace ergon
