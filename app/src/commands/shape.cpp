#include <cstdio>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "commands/commands.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/named_shapes.hpp"
#include "input/object_loading.hpp"

namespace graspfit::app {
namespace {

Command shape_command() {
  Command command{"shape", "NAME",
                  "Writes the mesh of an object built from its dimensions, to inspect and to plan "
                  "with:\nclosed, outward, in meters.\n",
                  option_group("Options"), ""};
  add_option(command.options, "out", "FILE", std::nullopt,
             "the file to write, replacing it: .obj, .off, .ply or .stl");
  add_option(command.options, "set", "NAME=VALUE,...", std::nullopt,
             "dimensions other than the default ones: lengths [m] and counts");
  add_option(command.options, "at", "X,Y,Z", "0,0,0",
             "where the shape's origin goes [m]: an obstacle beside an object, or a bin in which "
             "the object does not stand in the middle");
  add_switch(command.options, "list", "print all shapes with their dimensions and defaults");
  return command;
}

std::string list_text() {
  std::string text;
  for (const geometry::ShapeDescription& shape : geometry::shape_descriptions()) {
    text += shape.name + ": " + shape.what + '\n';
    for (const geometry::ShapeDimension& dimension : shape.dimensions) {
      text += "  " + dimension.name + '=' + base::shortest_decimal(dimension.value) + '\n';
    }
  }
  return text;
}

std::vector<geometry::ShapeDimension> read_dimensions(const Flags& flags) {
  std::vector<geometry::ShapeDimension> dimensions;
  if (!flags.has("set")) return dimensions;
  for (const auto& [name, value] : flags.settings("set")) dimensions.push_back({name, value});
  return dimensions;
}

}  // namespace

ExitCode run_shape(const std::vector<std::string>& arguments) {
  const Command command = shape_command();
  const Flags flags(command, arguments);
  if (flags.wants_help()) {
    std::fputs(help_text(command).c_str(), stdout);
    return kSuccess;
  }
  if (flags.has("list")) {
    std::fputs(list_text().c_str(), stdout);
    return kSuccess;
  }
  const std::string& name = flags.positional();
  if (!flags.has("out")) throw UsageError("no --out FILE given");
  geometry::TriangleMesh mesh = geometry::named_shape(name, read_dimensions(flags));
  const Eigen::Vector3d shift = flags.vector("at");
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex += shift;
  geometry::write_mesh(flags.text("out"), mesh);
  std::printf("%s: %zu vertices, %zu faces, %s\n", flags.text("out").c_str(), mesh.vertices.size(),
              mesh.faces.size(), extents_text(mesh).c_str());
  return kSuccess;
}

}  // namespace graspfit::app
