#include "runtime/output/pvd.h"

#include <fmt/format.h>

#include "runtime/output/atomic_file.h"
#include "runtime/output/xml.h"

namespace ergon {

void PvdSeries::add(double time, const std::string& file) {
  const std::string added =
      fmt::format("<DataSet timestep=\"{}\" group=\"\" part=\"0\" file=\"{}\"/>\n", time, xml_text(file));
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  for (const std::string& frame : frames_) text += frame;
  text += added + "</Collection>\n</VTKFile>\n";
  write_file(path_, text);
  frames_.push_back(added);
}

}  // namespace ergon
