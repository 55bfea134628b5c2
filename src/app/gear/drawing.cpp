#include "app/gear/drawing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <sstream>

#include "app/gear/facts.h"
#include "app/gear/section.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"
#include "elastogear/base/rotation.h"

namespace elastogear::app {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;
using Outlines = std::vector<std::vector<Vector2d>>;
using Box = Eigen::AlignedBox2d;

constexpr double kMm = 1e-3;
constexpr double kColumn = 39, kName = 16.5;  // font sizes, of a column of numbers and of their names
constexpr const char* kFill[] = {"#9fc3e0", "#f0c48a", "#a8d5a2", "#d5b3d9"};

// One view: of each member its outlines, mm, and the radii of circles about its axis.
struct View {
  std::vector<Outlines> member;
  std::vector<std::pair<Vector2d, double>> pitch_circles;
  Box box;
};

// The plane, which is given in the world, in the frame of a member.
Plane in_frame(const Plane& plane, const DriveMember& member) {
  const Eigen::Matrix3d R = rotation_matrix(member.rotation) * rotation_matrix({0, 0, member.angle});
  return {R.transpose() * (plane.point - member.position), R.transpose() * plane.e_1,
          R.transpose() * plane.e_2};
}

View view(const Plane& plane, const Drive& drive, const std::vector<mesh::Mesh>& meshes) {
  View v;
  const Vector3d normal = plane.e_1.cross(plane.e_2);
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const DriveMember& member = drive.members[i];
    Outlines outlines = section(meshes[i], in_frame(plane, member));
    for (auto& outline : outlines)
      for (Vector2d& x : outline) {
        x /= kMm;
        v.box.extend(x);
      }
    v.member.push_back(std::move(outlines));
    const Vector3d axis = rotation_matrix(member.rotation).col(2), at = member.position - plane.point;
    if (std::abs(axis.dot(normal)) > 0.9)
      v.pitch_circles.emplace_back(Vector2d(at.dot(plane.e_1), at.dot(plane.e_2)) / kMm,
                                   member.toothing.r / kMm);
  }
  return v;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", value);
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (char c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

// origin: of the view's box, at its lower left, on the sheet; SVG counts y downwards.
void write_view(std::ostream& out, const View& v, const Vector2d& origin) {
  const auto place = [&](const Vector2d& x) {
    return number(origin[0] + x[0] - v.box.min()[0]) + "," + number(origin[1] - x[1] + v.box.min()[1]);
  };
  const double line = v.box.sizes().maxCoeff() / 600;
  for (std::size_t i = 0; i < v.member.size(); ++i) {
    out << "<path fill-rule='evenodd' fill='" << kFill[i % std::size(kFill)]
        << "' stroke='#222' stroke-width='" << number(line) << "' d='";
    for (const auto& outline : v.member[i])
      for (std::size_t k = 0; k < outline.size(); ++k)
        out << (k == 0 ? "M" : "L") << place(outline[k]) << ' ';
    out << "Z'/>\n";
  }
  for (const auto& [centre, radius] : v.pitch_circles) {
    const std::string at = place(centre);
    const auto comma = at.find(',');
    out << "<circle cx='" << at.substr(0, comma) << "' cy='" << at.substr(comma + 1) << "' r='"
        << number(radius) << "' fill='none' stroke='#a00' stroke-dasharray='" << number(8 * line) << ' '
        << number(2 * line) << ' ' << number(line) << ' ' << number(2 * line) << "' stroke-width='"
        << number(0.7 * line) << "'/>\n";
  }
}

// Columns of names and values below the views.
double write_facts(std::ostream& out, const Drive& drive, const Vector2d& at, double width, double size) {
  struct Column {
    std::string title, colour;
    const drive::Facts* facts;
  };
  std::vector<Column> columns;
  for (std::size_t i = 0; i < drive.members.size(); ++i)
    columns.push_back({drive.members[i].name, kFill[i % std::size(kFill)], &drive.facts.members[i]});
  for (std::size_t i = 0; i < drive.pairs.size(); ++i)
    columns.push_back({pair_name(drive, drive.pairs[i]), "#fff", &drive.facts.pairs[i]});
  const double step = width / static_cast<double>(columns.size());
  double lowest = at[1];
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const double x = at[0] + step * static_cast<double>(i);
    double y = at[1];
    const auto text = [&](double from, const std::string& value, const char* style) {
      out << "<text x='" << number(from) << "' y='" << number(y) << "' font-size='" << number(size) << "' "
          << style << ">" << escaped(value) << "</text>\n";
    };
    out << "<rect x='" << number(x) << "' y='" << number(y - 0.8 * size) << "' width='" << number(0.8 * size)
        << "' height='" << number(0.8 * size) << "' fill='" << columns[i].colour << "'/>\n";
    text(x + 1.2 * size, columns[i].title, "font-weight='bold'");
    for (const drive::Fact& fact : *columns[i].facts) {
      y += 1.4 * size;
      text(x, fact.name, "fill='#555'");
      text(x + kName * size, app::text(fact), "");
    }
    lowest = std::max(lowest, y);
  }
  return lowest;
}

}  // namespace

void write_drawing(const std::string& path, const std::string& title, const Drive& drive,
                   const std::vector<mesh::Mesh>& meshes) {
  Plane across, along;
  if (!drive.pairs.empty())
    along.e_1 = (drive.members[drive.pairs[0].second].position - drive.members[drive.pairs[0].first].position)
                    .normalized();
  along.e_2 = Vector3d::UnitZ();
  const View left = view(across, drive, meshes), right = view(along, drive, meshes);
  require(!left.box.isEmpty() && !right.box.isEmpty(), path, ": the drive has no sections to draw");
  const double gap = 0.08 * left.box.sizes().maxCoeff();
  const double views = left.box.sizes()[0] + gap + right.box.sizes()[0], width = views + 2 * gap;
  const auto n_columns = static_cast<double>(drive.members.size() + drive.pairs.size());
  const double size = views / (kColumn * n_columns), top = gap + 2 * size;
  const double base = top + std::max(left.box.sizes()[1], right.box.sizes()[1]);
  std::ostringstream body;
  write_view(body, left, {gap, base});
  write_view(body, right, {2 * gap + left.box.sizes()[0], (base + top + right.box.sizes()[1]) / 2});
  const double lowest = write_facts(body, drive, {gap, base + gap}, views, size);
  std::ostringstream out;
  out << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " << number(width) << ' '
      << number(lowest + gap) << "' font-family='sans-serif'>\n<title>" << escaped(title)
      << ": sections of the gears and their numbers</title>\n"
      << "<rect width='100%' height='100%' fill='#fff'/>\n<text x='" << number(gap) << "' y='" << number(gap)
      << "' font-size='" << number(1.4 * size) << "' font-weight='bold'>" << escaped(title) << "</text>\n"
      << body.str() << "</svg>\n";
  write_file(path, out.str());
}

}  // namespace elastogear::app
