#include <algorithm>
#include <array>
#include <string>

#include "graspfit/base/errors.hpp"
#include "mesh_io/mesh_formats.hpp"
#include "mesh_io/text_scanner.hpp"

// OFF and OBJ.

namespace graspfit::geometry::internal {
namespace {

Eigen::Vector3d read_point(TextScanner& text) {
  const double x = text.coordinate();
  const double y = text.coordinate();
  const double z = text.coordinate();
  return {x, y, z};
}

// Number of elements to reserve memory for, of a stated number of elements that take at least
// `bytes` each in a file of `size` bytes: a false number must not cost memory.
std::size_t believable(std::int64_t count, std::size_t size, std::size_t bytes) {
  return std::min(static_cast<std::size_t>(count), size / bytes + 1);
}

template <typename Number>
void append(std::string& text, Number value) {
  std::array<char, 32> digits;
  text.append(digits.data(),
              std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

void append_point(std::string& text, const Eigen::Vector3d& point) {
  append(text, point[0]);
  text += ' ';
  append(text, point[1]);
  text += ' ';
  append(text, point[2]);
  text += '\n';
}

/// A line of the corners of a face, the first vertex having the number `first`.
void append_face(std::string& text, char keyword, const Face& face, std::int32_t first) {
  text += keyword;
  for (const std::int32_t vertex : face) {
    text += ' ';
    append(text, vertex + first);
  }
  text += '\n';
}

}  // namespace

PolygonSoup parse_off(std::string_view content) {
  TextScanner text(content);
  if (!text.next_line()) throw base::IoError("not an OFF mesh: there is no text");
  const std::string_view header = text.word();
  // Texture coordinates, colors and normals may come with a vertex; they follow its position.
  constexpr std::array<std::string_view, 8> kHeaders = {"OFF",   "COFF",   "NOFF",   "CNOFF",
                                                        "STOFF", "STCOFF", "STNOFF", "STCNOFF"};
  if (std::find(kHeaders.begin(), kHeaders.end(), header) == kHeaders.end()) {
    if (header == "4OFF" || header == "nOFF" || header == "4nOFF") {
      throw base::IoError("OFF meshes of other than three dimensions are not supported");
    }
    text.fail("not an OFF mesh: it starts with " + TextScanner::quoted(header) + ", not 'OFF'");
  }
  if (text.line_is_empty() && !text.next_line()) text.fail("the file ends after its header");
  const std::string_view first = text.word();
  if (first == "BINARY") throw base::IoError("binary OFF is not supported");
  std::int64_t num_vertices = 0;
  if (!TextScanner::parse(first, num_vertices)) {
    text.fail("expected the number of vertices, found " + TextScanner::quoted(first));
  }
  const std::int64_t num_faces = text.integer("the number of faces");
  if (num_vertices < 0 || num_faces < 0) text.fail("a number of vertices or faces is negative");

  PolygonSoup soup;
  soup.vertices.reserve(believable(num_vertices, content.size(), 6));
  for (std::int64_t i = 0; i < num_vertices; ++i) {
    if (!text.next_line()) {
      throw base::IoError("the file ends after " + std::to_string(i) + " of " +
                          std::to_string(num_vertices) + " vertices");
    }
    soup.vertices.push_back(read_point(text));
  }
  soup.polygon_begin.reserve(believable(num_faces, content.size(), 8));
  soup.corners.reserve(3 * soup.polygon_begin.capacity());
  for (std::int64_t i = 0; i < num_faces; ++i) {
    if (!text.next_line()) {
      throw base::IoError("the file ends after " + std::to_string(i) + " of " +
                          std::to_string(num_faces) + " faces");
    }
    const std::int64_t size = text.integer("a number of corners");
    if (size < 3) {
      text.fail("face " + std::to_string(i) + " has " + std::to_string(size) + " corners");
    }
    soup.polygon_begin.push_back(soup.corners.size());
    for (std::int64_t k = 0; k < size; ++k) {
      const std::int64_t vertex = text.integer("a vertex index");
      if (vertex < 0 || vertex >= num_vertices) {
        text.fail(out_of_range(static_cast<std::size_t>(i), vertex, soup.vertices.size()));
      }
      soup.corners.push_back(static_cast<std::int32_t>(vertex));
    }
  }
  return soup;
}

PolygonSoup parse_obj(std::string_view content) {
  PolygonSoup soup;
  // Faces may come before their vertices, so absolute indices are checked at the end.
  std::vector<std::int64_t> corners;
  std::vector<int> lines;
  TextScanner text(content);
  std::string first_words;
  while (text.next_line()) {
    const std::string_view keyword = text.word();
    if (keyword == "v") {
      soup.vertices.push_back(read_point(text));
    } else if (keyword == "f") {
      soup.polygon_begin.push_back(corners.size());
      lines.push_back(text.line_number());
      while (!text.line_is_empty()) {
        std::string_view corner = text.word();
        if (corner == "\\") {  // The face goes on in the next line.
          if (!text.next_line()) text.fail("the file ends inside a face");
          continue;
        }
        corner = corner.substr(0, corner.find('/'));
        std::int64_t index = 0;
        if (!TextScanner::parse(corner, index) || index == 0) {
          text.fail("expected a vertex index, found " + TextScanner::quoted(corner));
        }
        // Negative ones count back from the last vertex so far.
        corners.push_back(index > 0 ? index - 1
                                    : static_cast<std::int64_t>(soup.vertices.size()) + index);
      }
      const std::size_t size = corners.size() - soup.polygon_begin.back();
      if (size < 3) {
        text.fail("face " + std::to_string(soup.num_polygons() - 1) + " has " +
                  std::to_string(size) + " corners");
      }
    } else if (first_words.empty()) {
      first_words = "line " + std::to_string(text.line_number()) + " starts with " +
                    TextScanner::quoted(keyword);
    }
  }
  if (soup.vertices.empty() && soup.num_polygons() == 0) {
    throw base::IoError("not an OBJ mesh: no 'v' or 'f' lines" +
                        (first_words.empty() ? std::string() : "; " + first_words));
  }
  const auto count = static_cast<std::int64_t>(soup.vertices.size());
  soup.corners.reserve(corners.size());
  std::size_t polygon = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    while (polygon + 1 < soup.num_polygons() && soup.polygon_begin[polygon + 1] <= i) ++polygon;
    if (corners[i] < 0 || corners[i] >= count) {
      throw base::IoError("line " + std::to_string(lines[polygon]) + ": " +
                          out_of_range(polygon, corners[i] + 1, soup.vertices.size()));
    }
    soup.corners.push_back(static_cast<std::int32_t>(corners[i]));
  }
  return soup;
}

std::string format_off(const TriangleMesh& mesh) {
  std::string text = "OFF\n" + std::to_string(mesh.vertices.size()) + " " +
                     std::to_string(mesh.faces.size()) + " 0\n";
  for (const Eigen::Vector3d& vertex : mesh.vertices) append_point(text, vertex);
  for (const Face& face : mesh.faces) append_face(text, '3', face, 0);
  return text;
}

std::string format_obj(const TriangleMesh& mesh) {
  std::string text;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    text += "v ";
    append_point(text, vertex);
  }
  for (const Face& face : mesh.faces) append_face(text, 'f', face, 1);
  return text;
}

}  // namespace graspfit::geometry::internal
