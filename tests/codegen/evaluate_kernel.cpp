#include "tests/codegen/evaluate_kernel.h"

#include <algorithm>
#include <cstdlib>
#include <new>

#include "codegen/parts.h"

#include "runtime/lanes/lanes.h"
#include "tests/paths.h"

namespace ergon::testing {
namespace {

// 64-byte aligned doubles.
class Lanes {
 public:
  explicit Lanes(int n)
      : data_(static_cast<double*>(::operator new(sizeof(double) * static_cast<size_t>(n + 8), std::align_val_t(64)))) {
    for (int i = 0; i < n + 8; ++i) data_[i] = 0;
  }
  ~Lanes() { ::operator delete(data_, std::align_val_t(64)); }
  Lanes(const Lanes&) = delete;
  Lanes& operator=(const Lanes&) = delete;
  double* get() { return data_; }
  double& operator[](int i) { return data_[i]; }

 private:
  double* data_;
};

std::vector<double> gather_points(const Energy& energy, const Inputs& inputs) {
  std::vector<double> x;
  for (const Symbol* s : energy.with_role(Role::dof))
    x.insert(x.end(), inputs.at(s->name).begin(), inputs.at(s->name).end());
  return x;
}

// dq/dx, rows of q by columns of x.
std::vector<std::vector<double>> chain(const ErgonKernel& k, int n) {
  int m = 3 * k.q_vectors;
  std::vector<std::vector<double>> j(static_cast<size_t>(m), std::vector<double>(static_cast<size_t>(n), 0));
  for (int r = 0; r < m; ++r)
    for (int c = 0; c < n; ++c)
      j[static_cast<size_t>(r)][static_cast<size_t>(c)] =
          k.density ? (r == c) : (r % 3 == c % 3 ? k.weights[(r / 3) * k.points + c / 3] : 0.0);
  return j;
}

// Numbers that the kernel renews.
int updated(const ErgonKernel& k) {
  int n = 0;
  for (int i = 0; i < k.n_updates; ++i) n += k.inputs[k.updates[i]].rows * k.inputs[k.updates[i]].cols;
  return n;
}

}  // namespace

std::vector<int> test_widths() {
  std::vector<int> out = {1, 2};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) out.push_back(4);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) out.push_back(8);
#endif
  return out;
}

CompiledKernel test_kernel(const Energy& energy, const std::string& case_name, int lanes) {
  CompileOptions options;
  options.case_name = case_name;
  options.lanes = lanes;
  options.cache = test::built("/kernels");
  return compile(energy, options);
}

std::vector<KernelValue> evaluate_kernel(const Energy& energy, const ErgonKernel& k,
                                         const std::vector<Inputs>& states) {
  const int w = k.lanes, m = 3 * k.q_vectors;
  Lanes params(k.params), u(k.uniforms), raw(k.raw * w), e(k.elements * w), q(m * w), value(w), require(w),
      gradient(m * w), hessian(m * (m + 1) / 2 * w), clamped(m * (m + 1) / 2 * w), absolute(m * (m + 1) / 2 * w),
      changed(2 * w), renewed(std::max(updated(k), 1) * w);
  std::vector<KernelValue> out;
  for (size_t first = 0; first < states.size(); first += static_cast<size_t>(w)) {
    int n = 0;
    std::vector<std::vector<double>> j;
    for (int lane = 0; lane < w; ++lane) {
      const Inputs& inputs = states[std::min(first + static_cast<size_t>(lane), states.size() - 1)];
      for (int i = 0; i < k.n_inputs; ++i) {
        const ErgonInput& in = k.inputs[i];
        const std::vector<double>& from = inputs.at(in.name);
        for (int c = 0; c < in.rows * in.cols; ++c)
          (in.role == ERGON_PARAM ? params[in.offset + c] : raw[(in.offset + c) * w + lane]) =
              from[static_cast<size_t>(c)];
      }
      std::vector<double> x = gather_points(energy, inputs);
      n = static_cast<int>(x.size());
      j = chain(k, n);
      for (int r = 0; r < m; ++r) {
        double sum = 0;
        for (int c = 0; c < n; ++c)
          sum += j[static_cast<size_t>(r)][static_cast<size_t>(c)] * x[static_cast<size_t>(c)];
        if (k.displacement && r % 4 == 0) sum -= 1;  // F - I
        q[r * w + lane] = sum;
      }
    }
    k.prepare_uniforms(params.get(), u.get());
    k.prepare_elements(raw.get(), u.get(), e.get());
    lanes::lane_operations(w).evaluate_at(k, q.get(), e.get(), u.get(), value.get(), require.get(), gradient.get(),
                                          hessian.get());
    if (k.update != nullptr) k.update(q.get(), e.get(), u.get(), renewed.get());
    for (int mode = 0; mode < 2 && k.projected != nullptr; ++mode)
      k.projected(q.get(), e.get(), u.get(), mode, value.get(), gradient.get(), (mode ? absolute : clamped).get(),
                  changed.get() + mode * w);
    for (int lane = 0; lane < w && first + static_cast<size_t>(lane) < states.size(); ++lane) {
      KernelValue v;
      v.value = value[lane];
      v.require = require[lane];
      for (int i = 0; i < updated(k); ++i) v.update.push_back(renewed[i * w + lane]);
      v.gradient.assign(static_cast<size_t>(n), 0);
      v.hessian.assign(static_cast<size_t>(n * n), 0);
      v.q_hessian.assign(static_cast<size_t>(m * (m + 1) / 2), 0);
      const std::vector<Entry> entries = hessian_entries(k);
      for (size_t i = 0; i < entries.size(); ++i)
        v.q_hessian[static_cast<size_t>(entries[i].row * (entries[i].row + 1) / 2 + entries[i].column)] =
            hessian[static_cast<int>(i) * w + lane];
      for (int mode = 0; mode < 2 && k.projected != nullptr; ++mode) {
        v.changed[mode] = changed[mode * w + lane] > 0;
        for (int i = 0; i < m * (m + 1) / 2; ++i)
          v.projected[mode].push_back((mode ? absolute : clamped)[i * w + lane]);
      }
      auto h = [&](int a, int b) {
        return v.q_hessian[static_cast<size_t>(a >= b ? a * (a + 1) / 2 + b : b * (b + 1) / 2 + a)];
      };
      auto at = [&](int r, int c) { return j[static_cast<size_t>(r)][static_cast<size_t>(c)]; };
      for (int c = 0; c < n; ++c)
        for (int r = 0; r < m; ++r) v.gradient[static_cast<size_t>(c)] += at(r, c) * gradient[r * w + lane];
      for (int c = 0; c < n; ++c)
        for (int d = 0; d < n; ++d)
          for (int a = 0; a < m; ++a)
            for (int b = 0; b < m; ++b)
              if (at(a, c) != 0 && at(b, d) != 0)
                v.hessian[static_cast<size_t>(d * n + c)] += at(a, c) * h(a, b) * at(b, d);
      out.push_back(v);
    }
  }
  return out;
}

}  // namespace ergon::testing
