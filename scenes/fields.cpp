#include "scenes/fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "runtime/mesh/mesh_import.h"
#include "scenes/laws.h"
#include "scenes/number_table.h"

namespace ergon {
namespace {

constexpr const char* kOtherwise = "otherwise";

std::string point_text(const Eigen::Vector3d& x) { return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", x[0], x[1], x[2]); }

void check_formula(const Energy& energy, const LawField& field) {
  const Symbol& param = *field.param;
  const Quantity& found = field.value->formula->quantity();
  const Place& place = field.value->at("formula");
  if (found.shape != param.shape)
    throw SourceError(place, fmt::format("'{}' of {} is a {}, the formula gives a {}", param.name, energy.name,
                                         to_string(param.shape), to_string(found.shape)));
  if (!found.any_unit && found.unit != param.unit)
    throw SourceError(place,
                      fmt::format("'{}' of {} must be in {}, the formula gives {}; numbers in a formula are pure, "
                                  "constants with units are given beside it",
                                  param.name, energy.name, to_string(param.unit), to_string(found.unit)));
}

void check_regions(const Energy& energy, const LawField& field, const SceneObject& object) {
  std::vector<std::string> known;
  for (const SceneRegion& region : object.regions) known.push_back(region.name);
  for (const auto& [name, written] : field.value->regions) {
    if (name != kOtherwise && std::find(known.begin(), known.end(), name) == known.end())
      throw SourceError(
          written.key_place,
          fmt::format("object '{}' has no [[object.region]] named '{}' (it has {}){}", object.name, name,
                      known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", ")), did_you_mean(name, known)));
    checked_values(energy, *field.param, written);
  }
}

// The number of a cell as the mesh's file has it, and its centre.
std::string cell_text(const FieldPlace& where, int cell) {
  const Mesh& mesh = where.body->ordered;
  const int n = nodes_of(mesh.element);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (int a = 0; a < n; ++a) centre += mesh.X.col(mesh.cells[static_cast<size_t>(cell * n + a)]) / n;
  return fmt::format(" in cell {} of object '{}', at {}", where.body->cell_from[static_cast<size_t>(cell)],
                     where.body->name, point_text(centre));
}

// All that a formula needs while a scene runs.
struct PlacedFormula {
  Energy energy;
  Symbol param;
  std::shared_ptr<const FieldValue> value;
  Eigen::Matrix3Xd X;      // of the sites; one column of zeros for a formula in time alone
  std::vector<int> cells;  // that the sites are in, as the mesh's file numbers them; empty likewise
  std::string object;

  std::vector<double> at(double time) const {
    std::vector<double> out;
    for (int site = 0; site < X.cols(); ++site) {
      for (const double v : value->formula->at({X(0, site), X(1, site), X(2, site)}, time)) {
        if (!param.range.contains(v)) check_range(energy, param, v, value->at("formula"), where(site, time));
        out.push_back(v);
      }
    }
    return out;
  }
  std::string where(int site, double time) const {
    std::string out;
    if (!cells.empty())
      out = fmt::format(" in cell {} of object '{}', X = {}", cells[static_cast<size_t>(site)], object,
                        point_text(X.col(site)));
    return value->formula->of_time() ? out + fmt::format(" at t = {:.6g} s", time) : out;
  }
};

// Whether each cell, as the object's mesh file numbers them, is in a region that is a physical group of it.
std::vector<char> cells_of_group(const SceneRegion& region, const FieldPlace& where) {
  if (!where.object->mesh.ends_with(".msh"))
    throw SourceError(region.at("group"), fmt::format("only a mesh from a .msh file has physical groups; let a box say "
                                                      "which cells of object '{}' are in the region '{}'",
                                                      where.object->name, region.name));
  const std::string path = (std::filesystem::path(where.folder) / where.object->mesh).lexically_normal().string();
  const auto groups = read_mesh_groups(path);
  std::vector<std::string> names;
  for (const auto& [name, cells] : groups) names.push_back(name);
  const auto found = groups.find(region.group);
  if (found == groups.end())
    throw SourceError(region.at("group"),
                      names.empty()
                          ? fmt::format("{} has no physical groups of cells", path)
                          : fmt::format("{} has no physical group '{}' of cells (its groups: {}){}", path, region.group,
                                        fmt::join(names, ", "), did_you_mean(region.group, names)));
  std::vector<char> out(where.body->cell_from.size(), 0);
  for (const int cell : found->second) out[static_cast<size_t>(cell)] = 1;
  return out;
}

bool holds(const SceneRegion& region, const Eigen::Vector3d& point) {
  for (int i = 0; i < 3; ++i)
    if (!(region.min[static_cast<size_t>(i)] <= point[i] && point[i] <= region.max[static_cast<size_t>(i)]))
      return false;
  return true;
}

// Per cell of the ordered mesh.
std::vector<double> region_values(const Energy& energy, const LawField& field, const FieldPlace& where) {
  const Mesh& mesh = where.body->ordered;
  const auto size = static_cast<size_t>(field.param->shape.size());
  const int n = nodes_of(mesh.element);
  std::map<std::string, std::vector<double>> values;
  for (const auto& [name, written] : field.value->regions) values[name] = checked_values(energy, *field.param, written);
  std::map<std::string, std::vector<char>> groups;
  for (const SceneRegion& region : where.object->regions)
    if (values.contains(region.name) && region.wrote("group")) groups[region.name] = cells_of_group(region, where);
  std::vector<double> out;
  std::map<std::string, int> cells;
  for (int cell = 0; cell < mesh.cell_count(); ++cell) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (int a = 0; a < n; ++a) centre += mesh.X.col(mesh.cells[static_cast<size_t>(cell * n + a)]) / n;
    std::string name = kOtherwise;
    for (const SceneRegion& region : where.object->regions) {
      const auto group = groups.find(region.name);
      const bool inside =
          group == groups.end()
              ? holds(region, centre)
              : group->second[static_cast<size_t>(where.body->cell_from[static_cast<size_t>(cell)])] != 0;
      if (values.contains(region.name) && inside) name = region.name;
    }
    if (!values.contains(name))
      throw SourceError(field.value->at("regions"),
                        fmt::format("'{}' of {} has no value{}: no region that is named here holds it; give one for "
                                    "'{}'",
                                    field.param->name, energy.name, cell_text(where, cell), kOtherwise));
    ++cells[name];
    out.insert(out.end(), values[name].begin(), values[name].begin() + static_cast<ptrdiff_t>(size));
  }
  for (const SceneRegion& region : where.object->regions)
    if (values.contains(region.name) && cells[region.name] == 0)
      throw SourceError(region.place, fmt::format("the region '{}' of object '{}' holds the centre of no cell, or only "
                                                  "of cells that are in a later region",
                                                  region.name, where.object->name));
  return out;
}

// Rows of the file in the order of the ordered mesh.
std::vector<double> file_values(const Energy& energy, const LawField& field, const FieldPlace& where) {
  const FieldValue& value = *field.value;
  const bool of_cells = value.wrote("cells");
  const char* key = of_cells ? "cells" : "vertices";
  const std::string& written = of_cells ? value.cells : value.vertices;
  const NumberTable table =
      read_number_table((std::filesystem::path(where.folder) / written).lexically_normal().string(), value.at(key));
  const std::vector<int>& from = of_cells ? where.body->cell_from : where.body->vertex_from;
  if (table.rows() != from.size())
    throw SourceError(value.at(key), fmt::format("{} holds {} rows; object '{}' takes {}, one for each of its {}",
                                                 table.file, table.rows(), where.body->name, from.size(), key));
  const Symbol& param = *field.param;
  const std::string name = value.column.empty() ? param.name : value.column;
  const auto size = static_cast<size_t>(param.shape.size());
  std::vector<double> out(from.size() * size);
  for (size_t c = 0; c < size; ++c) {
    const NumberTable::Column& column = table.column(size == 1 ? name : fmt::format("{}_{}", name, c));
    if (!column.unit_text.empty() && column.unit.unit != param.unit)
      throw SourceError({table.file, 1, 1},
                        fmt::format("'{}' of {} must be in {}, the column '{}' is in {}", param.name, energy.name,
                                    to_string(param.unit), column.name, column.unit_text));
    for (size_t row = 0; row < column.values.size(); ++row)
      check_range(energy, param, column.values[row], {table.file, table.lines[row], 1},
                  fmt::format(" of {} {}", of_cells ? "cell" : "vertex", row));
    for (size_t i = 0; i < from.size(); ++i) out[i * size + c] = column.values[static_cast<size_t>(from[i])];
  }
  return out;
}

}  // namespace

std::vector<LawField> law_fields(const Energy& energy, const EnergyUse& use, const SceneObject& object) {
  std::vector<LawField> out;
  for (const Symbol* param : energy.with_role(Role::param)) {
    const auto written = use.params.find(param->name);
    if (written == use.params.end() || !written->second.field) continue;
    out.push_back({param, written->second.field, written->second.place});
    if (out.back().value->formula) check_formula(energy, out.back());
    check_regions(energy, out.back(), object);
  }
  return out;
}

TimedValues timed_values(const Energy& energy, const LawField& field, const FieldPlace& place) {
  auto formula = std::make_shared<PlacedFormula>(
      PlacedFormula{energy, *field.param, field.value, Eigen::Matrix3Xd::Zero(3, 1), {}, place.body->name});
  if (field.over_mesh()) {
    const Sites& sites = *place.sites;
    formula->X = sites.positions(place.body->ordered.X);
    for (size_t site = 0; site + 1 < sites.first_cell.size(); ++site) {
      const int cell = sites.cells[static_cast<size_t>(sites.first_cell[site])];
      formula->cells.push_back(place.body->cell_from[static_cast<size_t>(cell)]);
    }
  }
  return [formula](double time) { return formula->at(time); };
}

std::vector<double> field_values(const Energy& energy, const LawField& field, const FieldPlace& place) {
  if (field.value->formula) return timed_values(energy, field, place)(0);
  const int size = field.param->shape.size();
  if (field.value->wrote("regions")) return place.sites->of_cells(region_values(energy, field, place), size);
  const std::vector<double> values = file_values(energy, field, place);
  return field.value->wrote("cells") ? place.sites->of_cells(values, size) : place.sites->of_vertices(values, size);
}

}  // namespace ergon
