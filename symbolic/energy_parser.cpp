#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "symbolic/analyse.h"
#include "symbolic/declaration.h"
#include "symbolic/energy_parser.h"
#include "symbolic/expression_parser.h"

namespace ergon {
namespace {

const std::vector<std::string> headers = {"density", "energy", "barrier", "distance"};
const std::vector<std::string> keywords = {"density", "energy", "barrier", "distance", "cite",      "param", "lag",
                                           "rest",    "dof",    "let",     "active",   "require",   "frame", "value",
                                           "case",    "part",   "update",  "natural",  "constraint"};
constexpr const char* any_header =
    "`density NAME GEOMETRY`, `energy NAME STENCIL`, `barrier NAME` or `distance NAME STENCIL`";

std::string list(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

class EnergyParser {
 public:
  EnergyParser(const Statements& statements, std::string_view text, const std::string& file) {
    energy_.text = text;
    energy_.file = file;
    energy_.summary = statements.summary;
    if (statements.all.empty())
      throw SourceError({file, 0, 0}, fmt::format("expected {}, found an empty file", any_header));
    header(statements.all.front());
    for (size_t i = 1; i < statements.all.size(); ++i) read(statements.all[i]);
  }

  Energy finish() {
    if (!energy_.value && energy_.kind != Energy::Kind::distance)
      throw SourceError(header_,
                        fmt::format("'{}' has no value; expected a statement `value EXPRESSION`", energy_.name));
    analyse(energy_);
    return std::move(energy_);
  }

 private:
  struct Words {
    std::vector<std::string> text;
    std::vector<Place> places;
  };

  static Words split(const Statement& statement) {
    Words words;
    const std::string& text = statement.text;
    for (size_t at = text.find_first_not_of(" \t"); at < text.size();) {
      const size_t end = std::min(text.find_first_of(" \t", at), text.size());
      words.text.push_back(text.substr(at, end - at));
      words.places.push_back(statement.place(at));
      at = std::min(text.find_first_not_of(" \t", end), text.size());
    }
    words.places.push_back(statement.place(text.size()));
    return words;
  }

  void header(const Statement& statement) {
    const Words words = split(statement);
    header_ = words.places[0];
    const auto found = std::find(headers.begin(), headers.end(), words.text[0]);
    if (found == headers.end() && (words.text[0].starts_with("//") || words.text[0].starts_with("%")))
      throw SourceError(words.places[0], fmt::format("found '{}'; comments begin with '#'", words.text[0]));
    if (found == headers.end())
      throw SourceError(words.places[0],
                        fmt::format("expected {} as the first statement, found '{}'", any_header, words.text[0]) +
                            did_you_mean(words.text[0], headers));
    constexpr std::array kinds = {Energy::Kind::density, Energy::Kind::stencil, Energy::Kind::barrier,
                                  Energy::Kind::distance};
    energy_.kind = kinds[static_cast<size_t>(found - headers.begin())];
    const bool barrier = energy_.kind == Energy::Kind::barrier;
    const bool density = energy_.kind == Energy::Kind::density;
    const char* third = barrier ? "" : density ? " GEOMETRY" : " STENCIL";
    const size_t count = barrier ? 2 : 3;
    if (words.text.size() != count)
      throw SourceError(
          words.places[std::min<size_t>(words.text.size(), count)],
          fmt::format("expected `{} NAME{}`, found {}", words.text[0], third,
                      words.text.size() < count ? "the end of the statement" : "'" + words.text[count] + "'"));
    energy_.name = words.text[1];
    if (end_of_name(energy_.name, 0) != energy_.name.size())
      throw SourceError(words.places[1],
                        fmt::format("expected a name of letters, digits and '_', found '{}'", energy_.name));
    if (barrier) {
      const Unit metre = parse_unit("m").unit;
      energy_.symbols.push_back({"gap", Role::dof, {}, metre, {}, "distance beyond the offset", words.places[0]});
      energy_.symbols.push_back({"gap2", Role::dof, {}, pow(metre, {2, 1}), {}, "square of the gap", words.places[0]});
      return;
    }
    energy_.geometry = words.text[2];
    density ? density_geometry(words.places[2]) : stencil_geometry(words.places[2]);
  }

  void density_geometry(const Place& place) {
    static const std::vector<std::string> known = {"solid", "membrane", "line"};
    const std::optional<Shape> shape = shape_of_F(energy_.geometry);
    if (!shape && points_of_stencil(energy_.geometry) > 0)
      throw SourceError(place,
                        fmt::format("'{0}' is a stencil of points; a density is over one of {1}, and an energy of "
                                    "points begins with `energy {2} {0}`",
                                    energy_.geometry, list(known), energy_.name));
    if (!shape)
      throw SourceError(
          place, fmt::format("unknown geometry '{}'; a density is over one of {}", energy_.geometry, list(known)) +
                     did_you_mean(energy_.geometry, known));
    energy_.symbols.push_back({"F", Role::dof, *shape, {}, {}, "deformation gradient", place});
  }

  void stencil_geometry(const Place& place) {
    if (points_of_stencil(energy_.geometry) > 0) return;
    if (shape_of_F(energy_.geometry))
      throw SourceError(place,
                        fmt::format("'{0}' is what a density is over, as in `density {1} {0}`; an energy of points "
                                    "names a stencil: {2}",
                                    energy_.geometry, energy_.name, list(stencil_names())));
    throw SourceError(place,
                      fmt::format("unknown stencil '{}'; known are {}", energy_.geometry, list(stencil_names())) +
                          did_you_mean(energy_.geometry, stencil_names()));
  }

  void read(const Statement& statement) {
    const size_t end = end_of_name(statement.text, 0);
    const std::string word = statement.text.substr(0, end);
    const Place place = statement.place();
    const size_t next = statement.text.find_first_not_of(" \t", end);
    const bool given = end > 0 && next < statement.text.size() && statement.text[next] == '=';
    if (given && (word == "energy" || word == "density" || word == "psi" || word == "Psi" || word == "W"))
      throw SourceError(place,
                        fmt::format("unknown statement '{} = ...'; the energy is given by `value EXPRESSION`", word));
    if (std::find(headers.begin(), headers.end(), word) != headers.end())
      throw SourceError(place, fmt::format("a second header; a file holds one energy, and '{}' began in line {}",
                                           energy_.name, header_.line));
    if (word == "cite") return cite(statement, end);
    if (word == "param") return declare(statement, end, Role::param);
    if (word == "lag") return declare(statement, end, Role::lag);
    if (word == "rest") return declare(statement, end, Role::rest);
    if (word == "dof") return declare(statement, end, Role::dof);
    if (word == "frame") return frame(statement);
    if (word == "part") return part(statement, end);
    if (word == "load") return load(statement);

    if (word == "let" || word == "case" || word == "active" || word == "require" || word == "value" ||
        word == "update" || word == "natural" || word == "constraint") {
      ExpressionParser parser(tokenise(statement, end));
      if (word == "let") let(parser);
      if (word == "case") case_let(parser);
      if (word == "active" || word == "require") condition(parser, word, place);
      if (word == "value") value(parser, place);
      if (word == "update") update(parser, place);
      if (word == "natural") natural(parser, place);
      if (word == "constraint") constraint(parser, place);
      return;
    }
    const size_t blank = std::min(statement.text.find_first_of(" \t"), statement.text.size());
    std::string message = fmt::format("unknown statement '{}'", statement.text.substr(0, std::max(end, blank)));
    if (given) throw SourceError(place, message + fmt::format("; a name is given by `let {} = ...`", word));
    if (word == "return") throw SourceError(place, message + "; the energy is given by `value EXPRESSION`");
    throw SourceError(place,
                      message + fmt::format("; expected one of {}", list(keywords)) + did_you_mean(word, keywords));
  }

  void cite(const Statement& statement, size_t end) {
    const size_t start = statement.text.find_first_not_of(" \t", end);
    if (start == std::string::npos)
      throw SourceError(statement.place(end), "expected the source of the energy, found the end of the statement");
    if (!energy_.cite.empty()) energy_.cite += "; ";
    energy_.cite += statement.text.substr(start);
  }

  void part(const Statement& statement, size_t end) {
    const size_t start = statement.text.find_first_not_of(" \t", end);
    if (start == std::string::npos)
      throw SourceError(statement.place(end), "expected what the energy is a part of, found the end of the statement");
    if (!energy_.part_of.empty()) throw SourceError(statement.place(), "a second `part`; an energy states it once");
    energy_.part_of = statement.text.substr(start);
  }

  void load(const Statement& statement) {
    const Words words = split(statement);
    if (words.text.size() != 2)
      throw SourceError(words.places[std::min<size_t>(2, words.text.size())],
                        fmt::format("expected `load PARAM`, the param that the energy is in proportion to, found '{}'",
                                    statement.text));
    if (!energy_.load.empty()) throw SourceError(statement.place(), "a second `load`; an energy states it once");
    std::vector<std::string> params;
    for (const Symbol* param : energy_.with_role(Role::param)) params.push_back(param->name);
    if (std::find(params.begin(), params.end(), words.text[1]) == params.end())
      throw SourceError(words.places[1], fmt::format("`load` names a param that is declared above, and '{}' is none{}",
                                                     words.text[1], did_you_mean(words.text[1], params)));
    energy_.load = words.text[1];
  }

  void declare(const Statement& statement, size_t end, Role role) {
    if (role == Role::dof && energy_.kind == Energy::Kind::barrier)
      throw SourceError(statement.place(),
                        "a barrier is written over gap and gap2 alone, which are declared by its header; points belong "
                        "to a distance");
    if (role == Role::dof && energy_.kind == Energy::Kind::density)
      throw SourceError(statement.place(),
                        "a density is written over F alone, which is declared by its header; "
                        "energies over points begin with `energy NAME STENCIL`");
    for (Symbol& symbol : parse_declaration(statement, end, role)) {
      if (role == Role::dof && symbol.range != Range{})
        throw SourceError(symbol.place,
                          fmt::format("a dof has no range; keep '{}' within it by `require`", symbol.name));
      energy_.symbols.push_back(std::move(symbol));
    }
  }

  void frame(const Statement& statement) {
    const Words words = split(statement);
    if (words.text.size() != 2 || words.text[1] != "fixed")
      throw SourceError(words.places[std::min<size_t>(1, words.text.size())],
                        fmt::format("expected `frame fixed`, found '{}'", statement.text));
    energy_.fixed_frame = true;
  }

  void let(ExpressionParser& parser) {
    const Token name = parser.take_name("a name to give");
    finish_let(parser, name, "");
  }

  void case_let(ExpressionParser& parser) {
    if (energy_.kind == Energy::Kind::barrier)
      throw SourceError(parser.next().place, "a barrier is one function of the gap; cases belong to a distance");
    const Token case_name = parser.take_name("the name of the case, as in `case face gap2 = ...`");
    const Token name = parser.take_name("a name to give, as in `case face gap2 = ...`");
    auto& cases = energy_.cases;
    if (std::find(cases.begin(), cases.end(), case_name.text) == cases.end()) cases.push_back(case_name.text);
    finish_let(parser, name, case_name.text);
  }

  void update(ExpressionParser& parser, const Place& place) {
    if (!energy_.complete())
      throw SourceError(place,
                        "a barrier or distance renews nothing; `update` belongs to a density or a stencil energy");
    const Token name = parser.take_name("the lag to renew");
    parser.take_sign("=", fmt::format("after '{}'", name.text).c_str());
    energy_.updates.push_back({name.text, "", parser.expression(), name.place});
    parser.finish();
  }

  void natural(ExpressionParser& parser, const Place& place) {
    if (energy_.kind != Energy::Kind::density)
      throw SourceError(place,
                        "an energy of points is at rest where its rest data says; `natural` belongs to a density");
    if (energy_.natural) throw SourceError(place, "a second `natural`; a density states it once");
    energy_.natural = parser.expression();
    parser.finish();
  }

  void constraint(ExpressionParser& parser, const Place& place) {
    if (!energy_.complete())
      throw SourceError(place,
                        "a barrier or distance keeps to no equation; `constraint` belongs to a density or a "
                        "stencil energy");
    if (!energy_.constraint.empty())
      throw SourceError(place, fmt::format("a second constraint; '{}' has '{}' already: join them to one vector",
                                           energy_.name, energy_.constraint));
    const Token name = parser.take_name("the name of what the value draws to 0");
    finish_let(parser, name, "");
    energy_.constraint = name.text;
  }

  void finish_let(ExpressionParser& parser, const Token& name, const std::string& case_name) {
    parser.take_sign("=", fmt::format("after '{}'", name.text).c_str());
    Let let{name.text, case_name, parser.expression(), name.place};
    parser.finish();
    energy_.lets.push_back(std::move(let));
  }

  void condition(ExpressionParser& parser, const std::string& keyword, const Place& place) {
    if (keyword == "active" && energy_.kind == Energy::Kind::density)
      throw SourceError(place, "a density is active in every element; `active` belongs to stencil energies");
    if (keyword == "active" && energy_.kind == Energy::Kind::distance)
      throw SourceError(place, "a distance acts nowhere by itself; `active` belongs to the barrier over it");
    ExpressionPtr left = parser.expression();
    if (!parser.next().is("<") && !parser.next().is(">"))
      throw SourceError(parser.next().place,
                        fmt::format("expected '<' or '>' in a condition, found {}", to_string(parser.next())));
    const Token sign = parser.take();
    ExpressionPtr right = parser.expression();
    parser.finish();
    if (sign.is(">")) std::swap(left, right);
    (keyword == "active" ? energy_.active : energy_.require).push_back({left, right, sign.place});
  }

  void value(ExpressionParser& parser, const Place& place) {
    if (energy_.kind == Energy::Kind::distance)
      throw SourceError(place, "a distance has no value; it gives its gap by `let gap2 = ...` or `let gap = ...`");
    if (energy_.value)
      throw SourceError(place,
                        fmt::format("a second value; '{}' has one already in line {}", energy_.name, value_.line));
    value_ = place;
    energy_.value = parser.expression();
    parser.finish();
  }

  Energy energy_;
  Place header_, value_;
};

}  // namespace

Energy energy_of(const Statements& statements, std::string_view text, const std::string& file) {
  return EnergyParser(statements, text, file).finish();
}

Energy parse_energy(std::string_view text, const std::string& file) {
  return energy_of(split_statements(text, file), text, file);
}

}  // namespace ergon
