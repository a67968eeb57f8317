#pragma once
// Kernels made from an energy written once as a C++ template: derivatives by second-order forward differentiation, any
// vector width. Slow and simple, so that evaluation and assembly are tested without the compiler of energies.

#include <array>
#include <cmath>
#include <limits>

#include "runtime/potential.h"

namespace ergon::testing {

// A number with its gradient and Hessian in N variables.
template <int N>
struct Jet {
  double v = 0;
  Eigen::Matrix<double, N, 1> g = Eigen::Matrix<double, N, 1>::Zero();
  Eigen::Matrix<double, N, N> h = Eigen::Matrix<double, N, N>::Zero();

  Jet() = default;
  Jet(double value) : v(value) {}  // NOLINT: constants mix with jets
  static Jet variable(double value, int index) {
    Jet x(value);
    x.g(index) = 1;
    return x;
  }
  // f(x) from f, f' and f'' at v.
  Jet chain(double f, double d1, double d2) const {
    Jet y(f);
    y.g = d1 * g;
    y.h = d1 * h + d2 * (g * g.transpose());
    return y;
  }
};

template <int N>
Jet<N> operator+(Jet<N> a, const Jet<N>& b) {
  a.v += b.v, a.g += b.g, a.h += b.h;
  return a;
}
template <int N>
Jet<N> operator-(Jet<N> a, const Jet<N>& b) {
  a.v -= b.v, a.g -= b.g, a.h -= b.h;
  return a;
}
template <int N>
Jet<N> operator*(const Jet<N>& a, const Jet<N>& b) {
  Jet<N> c(a.v * b.v);
  c.g = a.v * b.g + b.v * a.g;
  c.h = a.v * b.h + b.v * a.h + a.g * b.g.transpose() + b.g * a.g.transpose();
  return c;
}
template <int N>
Jet<N> operator+(Jet<N> a, double b) {
  a.v += b;
  return a;
}
template <int N>
Jet<N> operator-(Jet<N> a, double b) {
  return a + -b;
}
template <int N>
Jet<N> operator*(double a, const Jet<N>& b) {
  return b.chain(a * b.v, a, 0);
}
template <int N>
Jet<N> sqrt(const Jet<N>& a) {
  const double s = std::sqrt(a.v);
  return a.chain(s, 0.5 / s, -0.25 / (s * a.v));
}
template <int N>
Jet<N> log(const Jet<N>& a) {
  return a.chain(std::log(a.v), 1 / a.v, -1 / (a.v * a.v));
}

template <class T>
T dot(const T* a, const T* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class T>
T triple(const T* a, const T* b, const T* c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// The table of a law: raw data of an element are what it reads, in the order of its inputs; uniforms are its params.
template <class Law, int W>
struct JetKernel {
  static constexpr int kSize = 3 * Law::kVectors;
  using J = Jet<kSize>;

  static void lane_data(const double* e, int lane, double* data) {
    for (int i = 0; i < Law::kRaw; ++i) data[i] = e[i * W + lane];
  }
  static J evaluate(const double* q, const double* e, const double* u, int lane) {
    J variables[kSize];
    double data[Law::kRaw + 1] = {};
    for (int i = 0; i < kSize; ++i) variables[i] = J::variable(q[i * W + lane], i);
    lane_data(e, lane, data);
    return Law::psi(variables, data, u);
  }
  static void prepare_uniforms(const double* params, double* u) {
    for (int i = 0; i < Law::kParams; ++i) u[i] = params[i];
  }
  static void prepare_elements(const double* raw, const double*, double* e) {
    for (int i = 0; i < Law::kRaw * W; ++i) e[i] = raw[i];
  }
  static void value(const double* q, const double* e, const double* u, double* value, double* require) {
    for (int l = 0; l < W; ++l) {
      double plain[kSize], data[Law::kRaw + 1] = {};
      for (int i = 0; i < kSize; ++i) plain[i] = q[i * W + l];
      lane_data(e, l, data);
      value[l] = Law::psi(plain, data, u);
      require[l] = Law::margin(plain, data, u);
    }
  }
  static void gradient(const double* q, const double* e, const double* u, double* value, double* gradient) {
    for (int l = 0; l < W; ++l) {
      const J y = evaluate(q, e, u, l);
      value[l] = y.v;
      for (int i = 0; i < kSize; ++i) gradient[i * W + l] = y.g(i);
    }
  }
  static void hessian(const double* q, const double* e, const double* u, double* value, double* gradient,
                      double* hessian) {
    for (int l = 0; l < W; ++l) {
      const J y = evaluate(q, e, u, l);
      value[l] = y.v;
      for (int i = 0; i < kSize; ++i) {
        gradient[i * W + l] = y.g(i);
        for (int j = 0; j <= i; ++j) hessian[(i * (i + 1) / 2 + j) * W + l] = y.h(i, j);
      }
    }
  }

  // The blocks of codegen/principal.h, read from the Hessian at F = diag(s).
  static void principal(const double* s, const double* e, const double* u, double* blocks) {
    constexpr int n = Law::kVectors;
    for (int l = 0; l < W; ++l) {
      double q[kSize * W] = {};
      for (int i = 0; i < n; ++i) q[4 * i * W + l] = s[i * W + l] - (Law::kDisplacement ? 1 : 0);
      const J y = evaluate(q, e, u, l);
      const auto h = [&](int a, int c, int b, int d) { return y.h(3 * c + a, 3 * d + b); };
      double* out = blocks + l;
      const auto give = [&](double value) { *out = value, out += W; };
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j <= i; ++j) give(h(i, i, j, j));
      }
      for (const int sign : {-1, 1}) {
        for (int k = 0; k < n * (n - 1) / 2; ++k) {
          const int i = n == 3 ? (k + 1) % 3 : 0, j = n == 3 ? (k + 2) % 3 : 1;
          give(h(i, j, i, j) + sign * h(i, j, j, i));
        }
      }
      for (int i = 0; n < 3 && i < n; ++i) give(h(2, i, 2, i));
    }
  }

  static ErgonKernel make() {
    ErgonKernel k{};
    k.abi = ERGON_KERNEL_ABI;
    k.lanes = W;
    k.energy = Law::kName;
    k.case_name = "";
    k.geometry = Law::kGeometry;
    k.density = Law::kPoints == 0;
    k.points = Law::kPoints;
    k.q_vectors = Law::kVectors;
    k.weights = Law::kPoints == 0 ? nullptr : Law::kWeights.data();
    k.n_inputs = static_cast<int>(Law::kInputs.size());
    k.inputs = Law::kInputs.data();
    k.params = k.uniforms = Law::kParams;
    k.raw = k.elements = Law::kRaw;
    k.requires_ = Law::kRequires;
    k.constant_hessian = Law::kConstant;
    k.zero_hessian = Law::kZero;
    k.prepare_uniforms = prepare_uniforms;
    k.prepare_elements = prepare_elements;
    k.value = value;
    k.gradient = gradient;
    k.hessian = hessian;
    k.displacement = Law::kDisplacement;
    k.principal = Law::kIsotropic ? principal : nullptr;
    k.point_names = Law::kPoints == 0 ? nullptr : Law::kPointNames.data();
    return k;
  }
  static Kernel kernel() {
    static const ErgonKernel table = make();
    return {nullptr, &table};
  }
};

template <class Law>
Kernel kernel_of(int lanes) {
  if (lanes == 8) return JetKernel<Law, 8>::kernel();
  if (lanes == 4) return JetKernel<Law, 4>::kernel();
  return lanes == 2 ? JetKernel<Law, 2>::kernel() : JetKernel<Law, 1>::kernel();
}

struct LawDefaults {
  static constexpr int kRequires = 0, kConstant = 0, kZero = 0, kDisplacement = 0, kIsotropic = 0;
  template <class T>
  static double margin(const T*, const double*, const double*) {
    return std::numeric_limits<double>::infinity();
  }
};

// Smith, de Goes, Kim 2018, with Lame parameters.
struct NeoHookeanLaw : LawDefaults {
  static constexpr const char* kName = "neo";
  static constexpr const char* kGeometry = "solid";
  static constexpr int kPoints = 0, kVectors = 3, kParams = 2, kRaw = 0;
  static constexpr std::array<double, 1> kWeights{};
  static constexpr std::array<const char*, 1> kPointNames{};
  static constexpr std::array<ErgonInput, 2> kInputs{{{"mu", ERGON_PARAM, 1, 1, 0}, {"lambda", ERGON_PARAM, 1, 1, 1}}};
  template <class T>
  static T psi(const T* F, const double*, const double* u) {
    const T J = triple(F, F + 3, F + 6) - 1.0;
    const T I = dot(F, F) + dot(F + 3, F + 3) + dot(F + 6, F + 6) - 3.0;
    return 0.5 * u[0] * I - u[0] * J + 0.5 * u[1] * (J * J);
  }
};

// A density with its closed form.
template <class Law>
struct Isotropic : Law {
  static constexpr int kIsotropic = 1;
};

// A solid's density over F - I.
template <class Law>
struct Displaced : Law {
  static constexpr int kDisplacement = 1;
  template <class T>
  static T psi(const T* q, const double* e, const double* u) {
    const T F[9] = {q[0] + 1.0, q[1], q[2], q[3], q[4] + 1.0, q[5], q[6], q[7], q[8] + 1.0};
    return Law::psi(F, e, u);
  }
};

// A fibre: (|F|^2 - 1)^2.
struct LineLaw : LawDefaults {
  static constexpr const char* kName = "fibre";
  static constexpr const char* kGeometry = "line";
  static constexpr int kPoints = 0, kVectors = 1, kParams = 1, kRaw = 0;
  static constexpr std::array<double, 1> kWeights{};
  static constexpr std::array<const char*, 1> kPointNames{};
  static constexpr std::array<ErgonInput, 1> kInputs{{{"k", ERGON_PARAM, 1, 1, 0}}};
  template <class T>
  static T psi(const T* F, const double*, const double* u) {
    const T a = dot(F, F) - 1.0;
    return u[0] * (a * a);
  }
};

// A membrane that resists stretch: |F'F - I|^2.
struct MembraneLaw : LawDefaults {
  static constexpr const char* kName = "sheet";
  static constexpr const char* kGeometry = "membrane";
  static constexpr int kPoints = 0, kVectors = 2, kParams = 1, kRaw = 0;
  static constexpr std::array<double, 1> kWeights{};
  static constexpr std::array<const char*, 1> kPointNames{};
  static constexpr std::array<ErgonInput, 1> kInputs{{{"k", ERGON_PARAM, 1, 1, 0}}};
  template <class T>
  static T psi(const T* F, const double*, const double* u) {
    const T a = dot(F, F) - 1.0, b = dot(F + 3, F + 3) - 1.0, c = dot(F, F + 3);
    return u[0] * (a * a + b * b + 2.0 * (c * c));
  }
};

struct SpringLaw : LawDefaults {
  static constexpr const char* kName = "spring";
  static constexpr const char* kGeometry = "edge";
  static constexpr int kPoints = 2, kVectors = 1, kParams = 1, kRaw = 6, kRequires = 1;
  static constexpr std::array<double, 2> kWeights{-1, 1};
  static constexpr std::array<const char*, 2> kPointNames{"x0", "x1"};
  static constexpr std::array<ErgonInput, 3> kInputs{
      {{"X0", ERGON_REST, 3, 1, 0}, {"X1", ERGON_REST, 3, 1, 3}, {"k", ERGON_PARAM, 1, 1, 0}}};
  static double length(const double* e) {
    const double d[3] = {e[3] - e[0], e[4] - e[1], e[5] - e[2]};
    return std::sqrt(dot(d, d));
  }
  template <class T>
  static T psi(const T* q, const double* e, const double* u) {
    using std::sqrt;
    const T stretch = sqrt(dot(q, q)) - length(e);
    return 0.5 * u[0] * (stretch * stretch);
  }
  static double margin(const double*, const double* e, const double*) { return length(e); }
};

// A hinge-like energy of three differences of four points, with all weights different.
struct HingeLaw : LawDefaults {
  static constexpr const char* kName = "hinge";
  static constexpr const char* kGeometry = "hinge";
  static constexpr int kPoints = 4, kVectors = 3, kParams = 1, kRaw = 1;
  static constexpr std::array<double, 12> kWeights{-1, 1, 0, 0, 0.5, -1.5, 1, 0, 0.25, 0.5, 0.25, -1};
  static constexpr std::array<const char*, 4> kPointNames{"x0", "x1", "x2", "x3"};
  static constexpr std::array<ErgonInput, 2> kInputs{{{"area", ERGON_REST, 1, 1, 0}, {"k", ERGON_PARAM, 1, 1, 0}}};
  template <class T>
  static T psi(const T* q, const double* e, const double* u) {
    const T volume = triple(q, q + 3, q + 6);
    return u[0] * e[0] * (volume * volume + dot(q, q + 3) * dot(q + 6, q + 6) + dot(q, q));
  }
};

// Three points, two vectors.
struct BendLaw : LawDefaults {
  static constexpr const char* kName = "bend";
  static constexpr const char* kGeometry = "triple";
  static constexpr int kPoints = 3, kVectors = 2, kParams = 0, kRaw = 0;
  static constexpr std::array<double, 6> kWeights{1, -2, 1, 0, -1, 1};
  static constexpr std::array<const char*, 3> kPointNames{"x0", "x1", "x2"};
  static constexpr std::array<ErgonInput, 0> kInputs{};
  template <class T>
  static T psi(const T* q, const double*, const double*) {
    return dot(q, q) * dot(q + 3, q + 3) - dot(q, q + 3);
  }
};

struct InertiaLaw : LawDefaults {
  static constexpr const char* kName = "inertia";
  static constexpr const char* kGeometry = "point";
  static constexpr int kPoints = 1, kVectors = 1, kParams = 0, kRaw = 5, kConstant = 1;
  static constexpr std::array<double, 1> kWeights{1};
  static constexpr std::array<const char*, 1> kPointNames{"x"};
  static constexpr std::array<ErgonInput, 3> kInputs{
      {{"mass", ERGON_REST, 1, 1, 0}, {"dt", ERGON_LAG, 1, 1, 1}, {"xhat", ERGON_LAG, 3, 1, 2}}};
  template <class T>
  static T psi(const T* q, const double* e, const double*) {
    const T d[3] = {q[0] - e[2], q[1] - e[3], q[2] - e[4]};
    return 0.5 * e[0] / (e[1] * e[1]) * dot(d, d);
  }
};

struct GravityLaw : LawDefaults {
  static constexpr const char* kName = "gravity";
  static constexpr const char* kGeometry = "point";
  static constexpr int kPoints = 1, kVectors = 1, kParams = 3, kRaw = 1, kConstant = 1, kZero = 1;
  static constexpr std::array<double, 1> kWeights{1};
  static constexpr std::array<const char*, 1> kPointNames{"x"};
  static constexpr std::array<ErgonInput, 2> kInputs{{{"mass", ERGON_REST, 1, 1, 0}, {"g", ERGON_PARAM, 3, 1, 0}}};
  template <class T>
  static T psi(const T* q, const double* e, const double* u) {
    return -e[0] * (u[0] * q[0] + u[1] * q[1] + u[2] * q[2]);
  }
};

// -kappa log(z), for z > 0.
struct BarrierLaw : LawDefaults {
  static constexpr const char* kName = "barrier";
  static constexpr const char* kGeometry = "point";
  static constexpr int kPoints = 1, kVectors = 1, kParams = 0, kRaw = 1, kRequires = 1;
  static constexpr std::array<double, 1> kWeights{1};
  static constexpr std::array<const char*, 1> kPointNames{"x"};
  static constexpr std::array<ErgonInput, 1> kInputs{{{"kappa", ERGON_LAG, 1, 1, 0}}};
  template <class T>
  static T psi(const T* q, const double* e, const double*) {
    using std::log;
    return -e[0] * log(q[2]);
  }
  static double margin(const double* q, const double*, const double*) { return q[2]; }
};

}  // namespace ergon::testing
