#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "mesh_io/byte_order.hpp"
#include "mesh_io/mesh_formats.hpp"
#include "mesh_io/text_scanner.hpp"

// PLY and STL, which come as text or binary.

namespace graspfit::geometry::internal {
namespace {

/// A type of numbers in PLY files.
struct PlyType {
  std::string_view name;
  std::string_view sized_name;
  std::size_t size;
  double (*value)(const char* bytes, bool is_little_endian);
};

template <typename Number>
constexpr PlyType stored_as(std::string_view name, std::string_view sized_name) {
  return {name, sized_name, sizeof(Number), [](const char* bytes, bool is_little_endian) {
            return static_cast<double>(decoded<Number>(bytes, is_little_endian));
          }};
}

constexpr std::array kPlyTypes = {
    stored_as<std::int8_t>("char", "int8"),    stored_as<std::uint8_t>("uchar", "uint8"),
    stored_as<std::int16_t>("short", "int16"), stored_as<std::uint16_t>("ushort", "uint16"),
    stored_as<std::int32_t>("int", "int32"),   stored_as<std::uint32_t>("uint", "uint32"),
    stored_as<float>("float", "float32"),      stored_as<double>("double", "float64")};

struct PlyProperty {
  std::string name;
  const PlyType* type = nullptr;
  const PlyType* size_type = nullptr;  // Only lists have one.
};

struct PlyElement {
  std::string name;
  std::int64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  enum class Format { Text, LittleEndian, BigEndian } format = Format::Text;
  std::vector<PlyElement> elements;
};

/// The type of this name, which the line at hand gives.
const PlyType* type_named(std::string_view name, const TextScanner& text) {
  const auto found = std::find_if(kPlyTypes.begin(), kPlyTypes.end(), [&](const PlyType& type) {
    return name == type.name || name == type.sized_name;
  });
  if (found == kPlyTypes.end()) text.fail("unknown type " + TextScanner::quoted(name));
  return &*found;
}

PlyHeader parse_ply_header(TextScanner& text) {
  if (!text.next_line(0) || text.word() != "ply") {
    throw base::IoError("not a PLY mesh: it does not start with 'ply'");
  }
  PlyHeader header;
  bool has_format = false;
  while (text.next_line(0)) {
    const std::string_view keyword = text.word();
    if (keyword == "end_header") {
      if (!has_format) text.fail("the header has no 'format'");
      return header;
    }
    if (keyword == "format") {
      const std::string_view name = text.word();
      has_format = true;
      if (name == "ascii") {
        header.format = PlyHeader::Format::Text;
      } else if (name == "binary_little_endian") {
        header.format = PlyHeader::Format::LittleEndian;
      } else if (name == "binary_big_endian") {
        header.format = PlyHeader::Format::BigEndian;
      } else {
        text.fail("unknown PLY format " + TextScanner::quoted(name));
      }
    } else if (keyword == "element") {
      PlyElement element;
      element.name = text.word();
      element.count = text.integer("a number of elements");
      if (element.count < 0) text.fail("a number of elements is negative");
      header.elements.push_back(element);
    } else if (keyword == "property") {
      if (header.elements.empty()) text.fail("a property before the first element");
      PlyProperty property;
      std::string_view type = text.word();
      if (type == "list") {
        property.size_type = type_named(text.word(), text);
        type = text.word();
      }
      property.type = type_named(type, text);
      property.name = text.word();
      header.elements.back().properties.push_back(property);
    } else if (keyword != "comment" && keyword != "obj_info") {
      text.fail("unexpected " + TextScanner::quoted(keyword) + " in the header");
    }
  }
  throw base::IoError("the file ends inside its header");
}

// The values of the body one after the other, from text or binary.
class PlyBody {
 public:
  PlyBody(TextScanner& text, PlyHeader::Format format)
      : text_(text), bytes_(text.rest()), format_(format) {}

  // Text has one element a line.
  bool begin_element() {
    return format_ == PlyHeader::Format::Text ? text_.next_line(0) : !bytes_.empty();
  }

  std::optional<double> value(const PlyType& type) {
    if (format_ == PlyHeader::Format::Text) {
      double number = 0.0;
      const std::string_view word = text_.word();
      if (word.empty()) return std::nullopt;
      if (!TextScanner::parse(word, number)) {
        text_.fail("expected a number, found " + TextScanner::quoted(word));
      }
      return number;
    }
    if (bytes_.size() < type.size) return std::nullopt;
    const double number = type.value(bytes_.data(), format_ == PlyHeader::Format::LittleEndian);
    bytes_.remove_prefix(type.size);
    return number;
  }

 private:
  TextScanner& text_;
  std::string_view bytes_;
  PlyHeader::Format format_;
};

// An element and its number, as in "face 3". Names that are not PLY's own may be any bytes.
std::string numbered(const PlyElement& element, std::int64_t i) {
  const bool is_known =
      element.name == "vertex" || element.name == "face" || element.name == "tristrips";
  return (is_known ? element.name : TextScanner::quoted(element.name)) + " " + std::to_string(i);
}

std::string truncated(const PlyElement& element, std::int64_t i) {
  return "the file ends at " + numbered(element, i) + " of " + std::to_string(element.count);
}

// Reads one element, handing every number to use(property index, value).
template <typename Use>
void read_element(PlyBody& body, const PlyElement& element, std::int64_t i, const Use& use) {
  if (element.properties.empty()) return;
  if (!body.begin_element()) throw base::IoError(truncated(element, i));
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const PlyProperty& property = element.properties[p];
    double size = 1.0;
    if (property.size_type) {
      const auto value = body.value(*property.size_type);
      if (!value) throw base::IoError(truncated(element, i));
      size = *value;
      if (!(size >= 0.0) || size != std::floor(size) || size > 1e9) {
        throw base::IoError(numbered(element, i) + ": bad list length");
      }
    }
    for (std::int64_t k = 0; k < static_cast<std::int64_t>(size); ++k) {
      const auto value = body.value(*property.type);
      if (!value) throw base::IoError(truncated(element, i));
      use(p, *value);
    }
  }
}

/// The index of a vertex, which comes as any number.
std::int32_t checked_index(double number, const std::string& where) {
  if (!(number >= 0.0 && number < 2147483648.0) || number != std::floor(number)) {
    throw base::IoError(where + " has a bad vertex index");
  }
  return static_cast<std::int32_t>(number);
}

/// Adds the triangles of a list of strips, each of which ends with −1: every three consecutive
/// corners are a triangle, and every second triangle has the opposite orientation. Triangles with a
/// repeated corner only continue the strip and are left out.
void add_strips(const std::vector<double>& corners, const std::string& where, PolygonSoup& soup) {
  std::vector<std::int32_t> strip;
  for (const double corner : corners) {
    if (corner == -1.0) {
      strip.clear();
      continue;
    }
    strip.push_back(checked_index(corner, where));
    if (strip.size() < 3) continue;
    const std::size_t i = strip.size() - 3;
    const std::int32_t a = strip[i + i % 2];
    const std::int32_t b = strip[i + 1 - i % 2];
    const std::int32_t c = strip[i + 2];
    if (a == b || b == c || c == a) continue;
    soup.polygon_begin.push_back(soup.corners.size());
    soup.corners.insert(soup.corners.end(), {a, b, c});
  }
}

PolygonSoup parse_text_stl(std::string_view content) {
  TextScanner text(content);
  PolygonSoup soup;
  int in_facet = 0;
  bool is_in_loop = false;
  while (text.next_line(0)) {
    const std::string_view keyword = text.word();
    if (keyword == "vertex") {
      if (!is_in_loop) text.fail("a vertex outside a loop");
      const double x = text.coordinate();
      const double y = text.coordinate();
      const double z = text.coordinate();
      soup.corners.push_back(base::as_index<std::int32_t>(soup.vertices.size()));
      soup.vertices.emplace_back(x, y, z);
      ++in_facet;
    } else if (keyword == "outer") {
      if (is_in_loop) text.fail("a loop inside a loop");
      soup.polygon_begin.push_back(soup.corners.size());
      in_facet = 0;
      is_in_loop = true;
    } else if (keyword == "endloop") {
      if (!is_in_loop || in_facet != 3) {
        text.fail("facet " + std::to_string(soup.num_polygons()) + " has " +
                  std::to_string(in_facet) + " vertices");
      }
      is_in_loop = false;
    } else if (keyword != "facet" && keyword != "endfacet" && keyword != "solid" &&
               keyword != "endsolid") {
      text.fail("expected a facet, found " + TextScanner::quoted(keyword));
    }
  }
  if (is_in_loop) throw base::IoError("the file ends inside a facet");
  return soup;
}

}  // namespace

PolygonSoup parse_ply(std::string_view content) {
  TextScanner text(content);
  const PlyHeader header = parse_ply_header(text);
  PlyBody body(text, header.format);
  PolygonSoup soup;
  bool has_points = false;
  std::vector<double> corners;
  for (const PlyElement& element : header.elements) {
    const auto index_of = [&](std::string_view name) {
      const auto found = std::find_if(element.properties.begin(), element.properties.end(),
                                      [&](const PlyProperty& p) { return p.name == name; });
      return found == element.properties.end() ? element.properties.size()
                                               : std::size_t(found - element.properties.begin());
    };
    const std::size_t none = element.properties.size();
    if (element.name == "vertex") {
      const std::array<std::size_t, 3> axes = {index_of("x"), index_of("y"), index_of("z")};
      for (const std::size_t axis : axes) {
        if (axis == none || element.properties[axis].size_type) {
          throw base::IoError("the vertices have no x, y and z");
        }
      }
      has_points = true;
      for (std::int64_t i = 0; i < element.count; ++i) {
        Eigen::Vector3d point = Eigen::Vector3d::Zero();
        read_element(body, element, i, [&](std::size_t p, double value) {
          for (int axis = 0; axis < 3; ++axis) {
            if (axes[axis] == p) point[axis] = value;
          }
        });
        soup.add_vertex(point);
      }
    } else if (element.name == "face" || element.name == "tristrips") {
      const bool is_face = element.name == "face";
      std::size_t list = index_of("vertex_indices");
      if (list == none) list = index_of("vertex_index");
      if (list == none || !element.properties[list].size_type) {
        throw base::IoError(std::string("the ") + (is_face ? "faces" : "strips") +
                            " have no list of vertex indices");
      }
      for (std::int64_t i = 0; i < element.count; ++i) {
        corners.clear();
        read_element(body, element, i, [&](std::size_t p, double value) {
          if (p == list) corners.push_back(value);
        });
        if (!is_face) {
          add_strips(corners, "strip list " + std::to_string(i), soup);
          continue;
        }
        if (corners.size() < 3) {
          throw base::IoError("face " + std::to_string(i) + " has " +
                              std::to_string(corners.size()) + " corners");
        }
        soup.polygon_begin.push_back(soup.corners.size());
        for (const double corner : corners) {
          soup.corners.push_back(checked_index(corner, "face " + std::to_string(i)));
        }
      }
    } else {
      for (std::int64_t i = 0; i < element.count; ++i) {
        read_element(body, element, i, [](std::size_t, double) {});
        if (element.properties.empty()) break;
      }
    }
  }
  if (!has_points) throw base::IoError("not a mesh: there are no vertices");
  for (std::size_t face = 0; face < soup.num_polygons(); ++face) {
    for (const std::int32_t corner : soup.polygon(face)) {
      if (static_cast<std::size_t>(corner) >= soup.vertices.size()) {
        throw base::IoError(out_of_range(face, corner, soup.vertices.size()));
      }
    }
  }
  return soup;
}

PolygonSoup parse_stl(std::string_view content) {
  // Binary: 80 bytes of anything (even "solid"), a count, and 50 bytes a triangle.
  constexpr std::size_t kHeader = 84;
  constexpr std::size_t kTriangle = 50;
  std::size_t count = 0;
  if (content.size() >= kHeader) count = decoded<std::uint32_t>(content.data() + 80, true);
  const bool is_binary = content.size() >= kHeader && content.size() == kHeader + kTriangle * count;
  if (!is_binary) {
    // Text holds no zero byte; a cut binary file does, in any count below 2^24.
    const bool is_text = content.find('\0') == std::string_view::npos;
    const std::string_view text = without_byte_order_mark(content);
    const std::size_t start = text.find_first_not_of(" \t\r\n");
    if (is_text && start != std::string_view::npos && text.substr(start, 5) == "solid") {
      return parse_text_stl(text);
    }
    if (is_text) throw base::IoError("not an STL mesh: text that does not start with 'solid'");
    if (content.size() < kHeader)
      throw base::IoError("the file ends inside its header of 84 bytes");
    const std::size_t whole = (content.size() - kHeader) / kTriangle;
    if (whole < count) {
      throw base::IoError("the file ends after " + std::to_string(whole) + " of " +
                          std::to_string(count) + " triangles");
    }
    throw base::IoError(std::to_string(count) + " triangles take " +
                        std::to_string(kHeader + kTriangle * count) + " bytes, the file has " +
                        std::to_string(content.size()));
  }
  PolygonSoup soup;
  soup.vertices.reserve(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    // Twelve floats: the normal, which is not used, and three corners.
    const char* const at = content.data() + kHeader + kTriangle * i + 12;
    soup.polygon_begin.push_back(soup.corners.size());
    for (int corner = 0; corner < 3; ++corner) {
      Eigen::Vector3d point;
      for (int axis = 0; axis < 3; ++axis) {
        point[axis] = decoded<float>(at + 12 * corner + 4 * axis, true);
      }
      soup.corners.push_back(base::as_index<std::int32_t>(soup.vertices.size()));
      soup.add_vertex(point);
    }
  }
  return soup;
}

std::string format_ply(const TriangleMesh& mesh) {
  std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                    std::to_string(mesh.vertices.size()) +
                    "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                    std::to_string(mesh.faces.size()) +
                    "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) append_little_endian(out, vertex[axis]);
  }
  for (const Face& f : mesh.faces) {
    append_little_endian(out, std::uint8_t{3});
    for (const std::int32_t vertex : f) append_little_endian(out, vertex);
  }
  return out;
}

std::string format_stl(const TriangleMesh& mesh) {
  std::string out(80, ' ');
  append_little_endian(out, static_cast<std::uint32_t>(mesh.faces.size()));
  const auto append_point = [&](const Eigen::Vector3d& point) {
    for (int axis = 0; axis < 3; ++axis) {
      append_little_endian(out, static_cast<float>(point[axis]));
    }
  };
  for (std::int32_t face = 0; face < std::ssize(mesh.faces); ++face) {
    append_point(face_normal(mesh, face));
    for (const Eigen::Vector3d& corner : corners(mesh, face)) append_point(corner);
    append_little_endian(out, std::uint16_t{0});
  }
  return out;
}

}  // namespace graspfit::geometry::internal
