#include "symbolic/natural.h"

#include "symbolic/elaborate.h"
#include "symbolic/sliced.h"

namespace ergon {
namespace {

using Kind = Expression::Kind;

ExpressionPtr joined(Kind kind, ExpressionPtr a, ExpressionPtr b, Shape shape) {
  const Place place = a->place;
  return std::make_shared<Expression>(Expression{kind, "", {std::move(a), std::move(b)}, place, shape, {}});
}

// The expression with another one in place of F.
ExpressionPtr with_F(const ExpressionPtr& e, const ExpressionPtr& F) {
  if (e->kind == Kind::name && e->text == "F") return F;
  auto out = std::make_shared<Expression>(*e);
  for (ExpressionPtr& argument : out->arguments) argument = with_F(argument, F);
  return out;
}

// Fe G, with F in the place of Fe.
ExpressionPtr product(const Energy& energy) {
  const Symbol& F = *energy.find("F");
  const auto Fe = std::make_shared<Expression>(Expression{Kind::name, F.name, {}, energy.natural->place, F.shape, {}});
  return joined(Kind::multiply, Fe, energy.natural, F.shape);
}

// Keeps what one expression is.
class Kept : public ClnAlgebra {
 public:
  Kept(const ExactInputs& inputs, const Expression* of) : ClnAlgebra(inputs, 50), of_(of) {}
  void formed(const Expression& e, const std::vector<ClnNumber>& components) {
    if (&e == of_) kept = components;
  }
  std::vector<ClnNumber> kept;

 private:
  const Expression* of_;
};

// Volume of the shape without stress over that at rest.
ExpressionPtr volume_ratio(const Energy& energy) {
  const ExpressionPtr& G = energy.natural;
  if (!G->shape.scalar())
    return std::make_shared<Expression>(Expression{Kind::call, "det", {G}, G->place, Shape{}, {}});
  ExpressionPtr out = G;
  for (int i = 1; i < energy.find("F")->shape.cols; ++i) out = joined(Kind::multiply, out, G, {});
  return out;
}

}  // namespace

Energy seen_from_natural(const Energy& energy) {
  if (!energy.natural) return energy;
  Energy out = energy;
  const ExpressionPtr F = product(energy);
  for (auto* lets : {&out.lets, &out.updates})
    for (Let& let : *lets) let.expression = with_F(let.expression, F);
  for (Condition& condition : out.require)
    condition = {with_F(condition.left, F), with_F(condition.right, F), condition.place};
  out.value = joined(Kind::divide, with_F(energy.value, F), volume_ratio(energy), {});
  return out;
}

ExactInputs seen_from_rest(const Energy& energy, const std::string& case_name, const ExactInputs& state) {
  if (!energy.natural) return state;
  const ExpressionPtr F = product(energy);
  Kept numbers(state, F.get());
  elaborate(sliced(energy, F), case_name, numbers);
  ExactInputs out = state;
  for (size_t i = 0; i < numbers.kept.size(); ++i) out.at("F")[i] = cln::rational(numbers.kept[i].value);
  return out;
}

}  // namespace ergon
