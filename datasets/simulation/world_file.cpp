// The [world] table: the corridor's keys or a drawing.
#include <fmt/format.h>

#include <cstdint>

#include "datasets/simulation/scenario_params.hpp"
#include "datasets/simulation/toml_input.hpp"
#include "datasets/simulation/world_table.hpp"
#include "slam/core/units.hpp"

namespace corridor::simulation {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kMaxMaterials = 255;

struct ArcRow {
  double radius_m = 0;
  double begin_deg = 0;
  double sweep_deg = 360;
  std::string material;
  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"radius_m", "m", "radius"}, p.radius_m);
    v(ParamInfo{"begin_deg", "deg", "where it begins, counter-clockwise from +x"}, p.begin_deg);
    v(ParamInfo{"sweep_deg", "deg", "how far it goes, counter-clockwise"}, p.sweep_deg);
    v(ParamInfo{"material", "", "name of a material; empty = the first, or plain"}, p.material);
  }
};

struct PolygonRow {
  bool closed = true;
  std::string material;
  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"closed", "", "the last point is joined to the first"}, p.closed);
    v(ParamInfo{"material", "", "name of a material; empty = the first, or plain"}, p.material);
  }
};

struct MaterialRow {
  Material material;
  static void visit(auto& p, auto&& v) {
    v(ParamInfo{"name", "", "name"}, p.material.name);
    v(ParamInfo{"range_factor", "1", "share of the LiDAR's range"}, p.material.range_factor);
    v(ParamInfo{"seen_within_deg", "deg", "largest angle to the normal that returns"},
      p.material.seen_within_deg);
  }
};

class DrawingReader {
 public:
  DrawingReader(const toml::table& table, std::vector<TomlProblem>& problems)
      : table_(table), problems_(problems) {}

  World read() {
    find_unknown_keys(table_, "world", {"polygons", "arcs", "materials", "route_m"}, problems_);
    for_each_row("materials", [&](const toml::table& row) { add_material(row); });
    for_each_row("polygons", [&](const toml::table& row) { add_polygon(row); });
    for_each_row("arcs", [&](const toml::table& row) { add_arc(row); });
    world_.material_of_surface = std::move(materials_of_walls_);
    world_.material_of_surface.insert(world_.material_of_surface.end(), materials_of_arcs_.begin(),
                                      materials_of_arcs_.end());
    if (world_.materials.empty()) world_.material_of_surface.clear();
    if (const toml::node* route = table_.get("route_m")) {
      world_.route_m = read_points(*route, "world.route_m", problems_);
    }
    return std::move(world_);
  }

 private:
  template <class Take>
  void for_each_row(std::string_view key, const Take& take) {
    const toml::node* node = table_.get(key);
    if (node == nullptr) return;
    const toml::array* rows = node->as_array();
    if (rows == nullptr) {
      problems_.push_back(
          formats::wrong_type(*node, fmt::format("world.{}", key), "a list of tables"));
      return;
    }
    for (const toml::node& row : *rows) {
      if (const toml::table* table = row.as_table()) {
        take(*table);
      } else {
        problem(row, fmt::format("world.{}: expected tables in the list", key));
      }
    }
  }

  void add_material(const toml::table& row) {
    MaterialRow read;
    read_table(row, "world.materials", MissingKeys::kKeepDefault, read, problems_);
    if (world_.materials.size() == kMaxMaterials) {
      problem(row, fmt::format("more than {} materials", kMaxMaterials));
      return;
    }
    world_.materials.push_back(read.material);
  }

  void add_polygon(const toml::table& row) {
    std::vector<Vector2d> points_m = points_of(row, "points_m", "world.polygons");
    PolygonRow read;
    read_table(row, "world.polygons", MissingKeys::kKeepDefault, read, problems_, {"points_m"});
    if (points_m.size() < 2) {
      problem(row, "world.polygons: expected at least two points in points_m");
      return;
    }
    if (read.closed && points_m.size() > 2) points_m.push_back(points_m.front());
    const std::uint8_t material = material_index(row, read.material);
    for (std::size_t i = 0; i + 1 < points_m.size(); ++i) {
      world_.walls.push_back({points_m[i], points_m[i + 1]});
      materials_of_walls_.push_back(material);
    }
  }

  void add_arc(const toml::table& row) {
    Vector2d centre_m = Vector2d::Zero();
    if (const toml::node* node = row.get("centre_m")) {
      centre_m = read_point(*node, "world.arcs.centre_m", problems_);
    } else {
      problem(row, "world.arcs.centre_m is missing; expected [x, y]");
    }
    ArcRow read;
    read_table(row, "world.arcs", MissingKeys::kKeepDefault, read, problems_, {"centre_m"});
    world_.arcs.push_back(
        {centre_m, read.radius_m, read.begin_deg * kRadPerDeg, read.sweep_deg * kRadPerDeg});
    materials_of_arcs_.push_back(material_index(row, read.material));
  }

  std::vector<Vector2d> points_of(const toml::table& row, std::string_view key,
                                  std::string_view section) {
    const toml::node* node = row.get(key);
    if (node == nullptr) return {};
    return read_points(*node, fmt::format("{}.{}", section, key), problems_);
  }

  std::uint8_t material_index(const toml::node& row, const std::string& name) {
    for (std::size_t i = 0; i < world_.materials.size(); ++i) {
      if (name.empty() || world_.materials[i].name == name) return static_cast<std::uint8_t>(i);
    }
    if (!name.empty()) problem(row, fmt::format("material \"{}\" is not in world.materials", name));
    return 0;
  }

  void problem(const toml::node& node, std::string text) {
    problems_.push_back({node.source().begin.line, std::move(text)});
  }

  const toml::table& table_;
  std::vector<TomlProblem>& problems_;
  World world_;
  std::vector<std::uint8_t> materials_of_walls_, materials_of_arcs_;
};

std::string point_text(const Vector2d& point_m) {
  return fmt::format("[{}, {}]", point_m.x(), point_m.y());
}

std::string material_text(const World& world, std::size_t surface_index) {
  return world.materials.empty()
             ? std::string()
             : fmt::format(", material = \"{}\"", world.material(surface_index).name);
}

std::string drawing_toml(const World& world) {
  std::string text = "[world]\n";
  const auto append_list = [&](std::string_view key, std::size_t size, const auto& row) {
    if (size == 0) return;
    text += fmt::format("{} = [\n", key);
    for (std::size_t i = 0; i < size; ++i) text += "  " + row(i) + ",\n";
    text += "]\n";
  };
  append_list("materials", world.materials.size(), [&](std::size_t i) {
    const Material& material = world.materials[i];
    return fmt::format("{{ name = \"{}\", range_factor = {}, seen_within_deg = {} }}",
                       material.name, material.range_factor, material.seen_within_deg);
  });
  append_list("polygons", world.walls.size(), [&](std::size_t i) {
    return fmt::format("{{ points_m = [{}, {}], closed = false{} }}",
                       point_text(world.walls[i].a_m), point_text(world.walls[i].b_m),
                       material_text(world, i));
  });
  append_list("arcs", world.arcs.size(), [&](std::size_t i) {
    const Arc& arc = world.arcs[i];
    return fmt::format("{{ centre_m = {}, radius_m = {}, begin_deg = {}, sweep_deg = {}{} }}",
                       point_text(arc.centre_m), arc.radius_m, arc.begin_rad / kRadPerDeg,
                       arc.sweep_rad / kRadPerDeg, material_text(world, world.walls.size() + i));
  });
  append_list("route_m", world.route_m.size(),
              [&](std::size_t i) { return point_text(world.route_m[i]); });
  return text;
}

}  // namespace

World read_world_table(const toml::table& table, std::vector<TomlProblem>& problems) {
  World world;
  if (table.contains("polygons") || table.contains("arcs")) {
    world = DrawingReader(table, problems).read();
  } else {
    WorldParams params{};
    read_table(table, "world", MissingKeys::kAreErrors, params, problems);
    world.corridor = to_shape(params);
  }
  if (!problems.empty()) return world;
  for (std::string& line : violations(world)) {
    const bool is_route = line.starts_with("world.route_m");
    const toml::node& node =
        is_route ? *table.get("route_m") : static_cast<const toml::node&>(table);
    problems.push_back({node.source().begin.line, std::move(line)});
  }
  if (problems.empty() && world.corridor) world = make_corridor(*world.corridor);
  return world;
}

Result<World> read_world(const std::filesystem::path& path) {
  const Result<toml::table> document = parse_toml(path);
  if (!document) return tl::make_unexpected(document.error());
  const toml::table* table = document->get_as<toml::table>("world");
  if (table == nullptr) {
    return fail(ErrorCode::kInvalid, "no [world] table", path.string(),
                "[world] with a_m b_m c_m alpha_deg doors_every_m, or with polygons");
  }
  std::vector<TomlProblem> problems;
  World world = read_world_table(*table, problems);
  if (!problems.empty()) return tl::make_unexpected(to_error(path, problems));
  return world;
}

std::string world_toml(const World& world) {
  if (!world.corridor) return drawing_toml(world);
  std::string text = "[world]\n";
  WorldParams params = to_params(*world.corridor);
  WorldParams::visit(params, [&](const ParamInfo& info, double& value) {
    text += fmt::format("{} = {}\n", info.name, value);
  });
  return text;
}

}  // namespace corridor::simulation
