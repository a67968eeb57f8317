#pragma once
// An energy written in C++. Each call is one statement of the language, and build() reads them as it reads a file
// (symbolic/energy_parser.h): the same checks and messages, told at the line of the call, the same Energy and with it
// the same kernel.
//
//   EnergyBuilder law("energy", "bungee", "edge");
//   const Expr x0 = law.dof("x0", "m"), x1 = law.dof("x1", "m");
//   const Expr length = law.rest("length", "m", "(0, inf)", "when slack");
//   const Expr k = law.param("k", "N/m", "(0, inf)", "stiffness");
//   const Expr stretch = law.let("stretch", norm(x1 - x0) - length);
//   law.value(k/2*pow(max(stretch, 0), 2));
//   const Energy bungee = law.build();

#include <string>

#include "symbolic/energy.h"
#include "symbolic/expr.h"
#include "symbolic/statements.h"

namespace ergon {

class EnergyBuilder {
 public:
  using Where = SourceLine;

  // `kind` as headers begin: "density", "energy", "barrier" (without geometry) or "distance".
  EnergyBuilder(const std::string& kind, const std::string& name, const std::string& geometry = "",
                Where where = Where::here());

  // What headers declare: F of a density, gap and gap2 of a barrier.
  Expr F() const { return Expr::named("F"); }
  Expr gap() const { return Expr::named("gap"); }
  Expr gap2() const { return Expr::named("gap2"); }

  // Declarations; what they give is the name. Name, unit and range are written as in a file: "A[3, 3]", "N/m",
  // "(0, inf)", "" for any.
  Expr dof(const std::string& name, const std::string& unit, Where where = Where::here());
  Expr param(const std::string& name, const std::string& unit, const std::string& range = "",
             const std::string& help = "", Where where = Where::here());
  Expr rest(const std::string& name, const std::string& unit, const std::string& range = "",
            const std::string& help = "", Where where = Where::here());
  Expr lag(const std::string& name, const std::string& unit, const std::string& range = "",
           const std::string& help = "", Where where = Where::here());

  // Parts with a name; what they give is the name.
  Expr let(const std::string& name, const Operand& expression);
  Expr case_let(const std::string& case_name, const std::string& name, const Operand& expression);

  Expr constraint(const std::string& name, const Operand& expression);

  void active(const Inequality& condition, Where where = Where::here());
  void require(const Inequality& condition, Where where = Where::here());
  void update(const Operand& lag, const Operand& expression);
  void natural(const Operand& expression);
  void value(const Operand& expression);

  void summary(const std::string& text, Where where = Where::here());
  void cite(const std::string& text, Where where = Where::here());
  void part(const std::string& text, Where where = Where::here());
  void load(const Operand& param);
  void fixed_frame(Where where = Where::here());

  // Throws SourceError at the line of the statement, or of the operation in it, that is at fault.
  Energy build() const;

  // As a file holds it.
  std::string text() const;

 private:
  // One statement: words, then an expression or none.
  void add(const std::string& words, const Where& where, const Operand* expression = nullptr);
  Expr declare(const std::string& keyword, const std::string& words, const Where& where);
  void check(const std::string& text, const Where& where) const;

  std::string file_;
  Statements statements_;
};

}  // namespace ergon
