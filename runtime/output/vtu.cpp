#include "runtime/output/vtu.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <set>

#include "runtime/error.h"
#include "runtime/output/atomic_file.h"
#include "runtime/output/xml.h"

namespace ergon {
namespace {

// The arrays behind the header: each its length in bytes and then its bytes, found by the offset in the header.
class AppendedData {
 public:
  template <class Number>
  std::string array(const std::string& name, const char* type, long components, const Number* numbers, size_t count,
                    const std::string& attributes = "") {
    const std::string element = fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{} format=\"appended\" offset=\"{}\"/>\n", type,
        xml_text(name), components, attributes, bytes_.size());
    const std::uint64_t size = count * sizeof(Number);
    bytes_.append(reinterpret_cast<const char*>(&size), sizeof size);
    if (count > 0) bytes_.append(reinterpret_cast<const char*>(numbers), size);
    return element;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

struct CellArrays {
  std::vector<std::int64_t> nodes, ends;
  std::vector<std::uint8_t> types;
};

CellArrays cell_arrays(const std::string& path, const Frame& frame) {
  CellArrays arrays;
  for (const CellBlock& block : frame.cells) {
    const size_t count = static_cast<size_t>(nodes_of(block.element));
    if (block.nodes.size() % count != 0) {
      throw InputError(fmt::format("{}: {} node numbers do not divide into {} cells", path, block.nodes.size(),
                                   name_of(block.element)));
    }
    for (size_t i = 0; i < block.nodes.size(); ++i) {
      if (block.nodes[i] < 0 || block.nodes[i] >= frame.x.cols()) {
        throw InputError(fmt::format("{}: a {} cell names point {}, but there are only {}", path,
                                     name_of(block.element), block.nodes[i], frame.x.cols()));
      }
      arrays.nodes.push_back(block.nodes[i]);
      if (i % count == count - 1) {
        arrays.ends.push_back(static_cast<std::int64_t>(arrays.nodes.size()));
        arrays.types.push_back(static_cast<std::uint8_t>(vtk_cell_type(block.element)));
      }
    }
  }
  return arrays;
}

void check_fields(const std::string& path, const std::vector<Field>& fields, size_t count, const char* of) {
  std::set<std::string> names;
  for (const Field& field : fields) {
    if (field.name.empty()) throw InputError(fmt::format("{}: a field on the {} has no name", path, of));
    if (!names.insert(field.name).second) {
      throw InputError(fmt::format("{}: two fields on the {} are named '{}'", path, of, field.name));
    }
    if (static_cast<size_t>(field.values.cols()) != count || field.values.rows() < 1) {
      throw InputError(fmt::format("{}: field '{}' is {} x {}; it must have a column for each of the {} {}", path,
                                   field.name, field.values.rows(), field.values.cols(), count, of));
    }
  }
}

std::string fields_element(const char* name, const std::vector<Field>& fields, AppendedData& data) {
  std::string text = fmt::format("<{}>\n", name);
  for (const Field& field : fields) {
    text += data.array(field.name, "Float64", field.values.rows(), field.values.data(),
                       static_cast<size_t>(field.values.size()));
  }
  return text + fmt::format("</{}>\n", name);
}

}  // namespace

void write_vtu(const std::string& path, const Frame& frame) {
  const CellArrays cells = cell_arrays(path, frame);
  const size_t points = static_cast<size_t>(frame.x.cols());
  check_fields(path, frame.point_data, points, "points");
  check_fields(path, frame.cell_data, cells.types.size(), "cells");

  AppendedData data;
  std::string header = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" header_type=\"UInt64\">\n"
      "<UnstructuredGrid>\n",
      std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian");
  header += "<FieldData>\n" + data.array("TimeValue", "Float64", 1, &frame.time, 1, " NumberOfTuples=\"1\"") +
            "</FieldData>\n";
  header += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", points, cells.types.size());
  header += fields_element("PointData", frame.point_data, data);
  header += fields_element("CellData", frame.cell_data, data);
  header += "<Points>\n" + data.array("Points", "Float64", 3, frame.x.data(), 3 * points) + "</Points>\n<Cells>\n";
  header += data.array("connectivity", "Int64", 1, cells.nodes.data(), cells.nodes.size());
  header += data.array("offsets", "Int64", 1, cells.ends.data(), cells.ends.size());
  header += data.array("types", "UInt8", 1, cells.types.data(), cells.types.size());
  header += "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";

  AtomicFile file(path);
  file.write(header);
  file.write(data.bytes());
  file.write("\n</AppendedData>\n</VTKFile>\n");
  file.commit();
}

}  // namespace ergon
