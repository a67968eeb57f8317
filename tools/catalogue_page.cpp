#include "tools/catalogue_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "codegen/compile.h"
#include "symbolic/analyse.h"
#include "symbolic/checks.h"
#include "symbolic/declaration.h"
#include "symbolic/print.h"
#include "tools/installation.h"
#include "tools/kernel_findings.h"
#include "tools/response.h"

namespace ergon {
namespace {

constexpr const char* kStyle =
    "body{font-family:sans-serif;max-width:1120px;margin:1em auto;padding:0 1em;line-height:1.4}"
    "table.data{border-collapse:collapse;margin:.6em 0}table.data td,table.data th{border-bottom:1px solid #ddd;"
    "padding:.15em .7em;text-align:left;vertical-align:top}section{border-top:2px solid #888;margin-top:2em}"
    "math{text-align:left;margin:.8em "
    "0}svg{max-width:100%;height:auto}.cite{color:#555}.kind{color:#666;font-weight:normal;"
    "font-size:80%}pre{background:#f6f6f6;padding:.6em;overflow:auto}nav a{margin-right:.9em}";

std::string kind_text(const Energy& energy) {
  if (energy.kind == Energy::Kind::barrier) return "law of contact over a gap, in J";
  if (energy.kind == Energy::Kind::distance) return fmt::format("distance, over {}", energy.geometry);
  return fmt::format("{} over {}, in {}", energy.kind == Energy::Kind::density ? "density" : "energy", energy.geometry,
                     to_string(value_unit(energy)));
}

std::string cells(const char* tag, const std::vector<std::string>& texts) {
  std::string out = "<tr>";
  for (const std::string& text : texts) out += fmt::format("<{0}>{1}</{0}>", tag, xml_text(text));
  return out + "</tr>\n";
}

std::string symbols_of(const Energy& energy) {
  std::string rows = cells("th", {"name", "role", "shape", "unit", "range", "meaning"});
  for (const Symbol& symbol : energy.symbols)
    rows += cells("td", {symbol.name, std::string(to_string(symbol.role)), to_string(symbol.shape),
                         to_string(symbol.unit), symbol.range == Range{} ? "" : to_string(symbol.range), symbol.help});
  return "<table class=\"data\">\n" + rows + "</table>\n";
}

std::string costs_of(const Energy& energy) {
  std::string rows = cells("th", {"case", "operations: value", "with gradient", "with Hessian", "divisions", "roots",
                                  "functions", "structure"});
  for (const std::string& name : cases_of(energy)) {
    const OperationCounts n = generate(energy, compile_options(name, 1)).counts;
    const auto text = [](int count) { return std::to_string(count); };
    rows += cells("td", {name, text(n.value), text(n.gradient), text(n.hessian), text(n.divisions), text(n.roots),
                         text(n.calls), structure_text(energy, name)});
  }
  return "<table class=\"data\">\n" + rows + "</table>\n";
}

// Each check once, with what it found worst.
std::string checks_of(const Energy& energy) {
  std::string rows;
  for (const Finding& finding : check_energy(energy)) {
    constexpr std::array marks = {"✓", "note", "warning", "error"};
    rows += cells("td", {marks[static_cast<size_t>(finding.severity)], finding.check, finding.message});
  }
  return "<table class=\"data\">\n" + rows + "</table>\n";
}

std::string section_of(const Energy& energy) {
  const Energy whole = shown_whole(energy);
  const Response response = response_of(whole, {});
  std::string out = fmt::format("<section id=\"{0}\">\n<h2>{0} <span class=\"kind\">{1}</span></h2>\n", energy.name,
                                xml_text(kind_text(energy)));
  if (!energy.summary.empty()) out += fmt::format("<p>{}</p>\n", xml_text(energy.summary));
  if (!energy.cite.empty()) out += fmt::format("<p class=\"cite\">{}</p>\n", xml_text(energy.cite));
  out += formula_mathml(energy) + symbols_of(energy);
  out += svg_of(charts_of(response), fmt::format("{}{}{}", whole.name, response.data.empty() ? "" : " with ",
                                                 data_text(whole, response.data)));
  const std::string of_whole = energy.complete() ? "" : fmt::format("<p>As {}:</p>\n", xml_text(whole.name));
  out += of_whole + costs_of(whole) + checks_of(whole);
  return out + fmt::format("<details><summary>the file</summary><pre>{}</pre></details>\n</section>\n",
                           xml_text(energy.text));
}

}  // namespace

Energy shown_whole(const Energy& energy) {
  if (energy.complete()) return energy;
  std::vector<Energy> all = complete(energy);
  for (Energy& whole : all)
    if (whole.name.ends_with(":point_point")) return std::move(whole);
  return std::move(all.front());
}

std::string catalogue_page(const std::vector<Energy>& energies) {
  std::string links, sections;
  for (const Energy& energy : energies) {
    links += fmt::format("<a href=\"#{0}\">{0}</a>\n", energy.name);
    sections += section_of(energy);
  }
  const std::string title = energies.size() == 1 ? energies.front().name : "Energies";
  return fmt::format(
      "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n<nav>\n{2}</nav>\n{3}</body>\n</html>\n",
      title, kStyle, links, sections);
}

}  // namespace ergon
