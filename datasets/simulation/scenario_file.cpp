// Scenario files: bases, worlds, presets.
#include "datasets/simulation/scenario_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "datasets/formats/maps/ros_map.hpp"
#include "datasets/simulation/scenario_sections.hpp"
#include "datasets/simulation/toml_input.hpp"
#include "datasets/simulation/world_table.hpp"

namespace corridor::simulation {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxBases = 8;  // a chain longer than this goes round in a circle

fs::path presets_path() { return fs::path(CORRIDOR_SCENARIO_DIR) / "presets" / "sensors.toml"; }

class ScenarioReader {
 public:
  explicit ScenarioReader(const fs::path& path, const SensorPreset& preset = {})
      : path_(path), preset_(preset) {}

  // Onto the values of `scenario`.
  Result<Scenario> read(Scenario scenario, int num_bases) {
    const Result<toml::table> document = parse_toml(path_);
    if (!document) return tl::make_unexpected(document.error());
    document_ = &*document;
    if (Result<void> based = read_base(scenario, num_bases); !based) {
      return tl::make_unexpected(based.error());
    }
    scenario.name = path_.stem().string();
    read_name(scenario.name);
    read_text("description", scenario.description);
    read_world_section(scenario);
    const bool is_world_read =
        problems_.empty();  // else its rules would only repeat that it is not
    for_each_section(scenario, [&](const char* section, auto& params) {
      if (std::string_view(section) == "world") return;
      known_.emplace_back(section);
      read_section(section, params);
    });
    find_unknown_keys(*document_, "", known_, problems_);
    if (is_world_read) {
      for (std::string& line : violations(scenario)) {
        const std::uint32_t line_number = formats::line_of_violation(*document_, line);
        problems_.push_back({line_number, std::move(line)});
      }
    }
    if (!problems_.empty()) return tl::make_unexpected(to_error(path_, problems_));
    return scenario;
  }

 private:
  Result<void> read_base(Scenario& scenario, int num_bases) {
    std::string base;
    read_text("base", base);
    if (base.empty()) return {};
    const std::string place =
        fmt::format("{}:{}", path_.string(), document_->get("base")->source().begin.line);
    if (num_bases == kMaxBases) {
      return fail(ErrorCode::kInvalid,
                  fmt::format("more than {} scenarios on one another", kMaxBases), place,
                  "bases that do not go round in a circle");
    }
    std::error_code error;
    const fs::path beside = path_.parent_path() / base;
    const Result<fs::path> base_path =
        fs::is_regular_file(beside, error) ? Result<fs::path>(beside) : find_scenario(base);
    if (!base_path) {
      return fail(base_path.error().code,
                  fmt::format("base = \"{}\": {}", base, base_path.error().what), place,
                  "a file beside this one, " + base_path.error().expected);
    }
    Result<Scenario> read = ScenarioReader(*base_path).read(std::move(scenario), num_bases + 1);
    if (!read) return tl::make_unexpected(read.error());
    scenario = std::move(*read);
    return {};
  }

  void read_text(const char* key, std::string& text) {
    known_.emplace_back(key);
    const toml::node* node = document_->get(key);
    if (node != nullptr && !read_value(*node, text)) {
      problems_.push_back(formats::wrong_type(*node, key, "text"));
    }
  }

  // A scenario is found and told by its file's name: another one inside would mislead.
  void read_name(std::string& name) {
    const std::string name_of_file = name;
    read_text("name", name);
    if (name == name_of_file || document_->get("name") == nullptr) return;
    problem(*document_->get("name"), fmt::format("name = \"{}\"; expected \"{}\", as the file is "
                                                 "called",
                                                 name, name_of_file));
  }

  void read_world_section(Scenario& scenario) {
    known_.emplace_back("world");
    known_.emplace_back("family");
    const toml::node* node = document_->get("world");
    if (node == nullptr) return;
    const toml::table* table = node->as_table();
    if (table == nullptr) {
      problems_.push_back(formats::no_table(*node, "world"));
    } else if (table->contains("map")) {
      scenario.world = read_map(*table);
    } else if (table->contains("polygons") || table->contains("arcs")) {
      scenario.world = read_world_table(*table, problems_);
    } else if (!scenario.world.corridor) {
      read_other_route(*table, scenario.world);
    } else {
      CorridorShape shape = scenario.world.corridor.value_or(CorridorShape{});
      WorldParams params = to_params(shape);
      read_table(*table, "world", MissingKeys::kKeepDefault, params, problems_);
      shape = to_shape(params);
      scenario.world = World{};
      scenario.world.corridor = shape;
      if (violations(shape).empty()) scenario.world = make_corridor(shape);
    }
  }

  // Another way through the drawing or map of the base, which is otherwise taken as a whole.
  void read_other_route(const toml::table& table, World& world) {
    for (const auto& [key, node] : table) {
      if (key.str() == "route_m") {
        world.route_m = read_points(node, "world.route_m", problems_);
        continue;
      }
      problem(node, fmt::format("world.{} on a base that is drawn; expected route_m alone, or a "
                                "world of its own: polygons, arcs or map",
                                key.str()));
    }
  }

  World read_map(const toml::table& table) {
    find_unknown_keys(table, "world", {"map", "route_m"}, problems_);
    std::string name;
    World world;
    if (!read_value(*table.get("map"), name)) {
      problems_.push_back(
          formats::wrong_type(*table.get("map"), "world.map", "the name of a yaml file"));
      return world;
    }
    const Result<GridMap> map = formats::read_ros_map(path_.parent_path() / name);
    if (!map) {
      problem(*table.get("map"), map.error().to_line());
      return world;
    }
    world = traced_world(*map);
    if (const toml::node* route = table.get("route_m")) {
      world.route_m = read_points(*route, "world.route_m", problems_);
    }
    return world;
  }

  template <class P>
  void read_section(const char* section, P& params) {
    const bool has_preset = preset_.section == section;
    if (has_preset) read_preset(section, preset_.name, 0, params);
    const toml::node* node = document_->get(section);
    if (node == nullptr) return;
    const toml::table* table = node->as_table();
    if (table == nullptr) {
      problems_.push_back(formats::no_table(*node, section));
      return;
    }
    std::string name;
    const toml::node* preset = table->get("preset");
    if (preset != nullptr && !read_value(*preset, name)) {
      problems_.push_back(formats::wrong_type(*preset, fmt::format("{}.preset", section), "text"));
    } else if (preset != nullptr && !has_preset) {
      read_preset(section, name, preset->source().begin.line, params);
    }
    read_table(*table, section, MissingKeys::kKeepDefault, params, problems_, {"preset"});
  }

  template <class P>
  void read_preset(const char* section, const std::string& name, std::uint32_t line, P& params) {
    const Result<toml::table> presets = parse_toml(presets_path());
    if (!presets) {
      problems_.push_back({line, presets.error().to_line()});
      return;
    }
    const toml::table* of_section = presets->get_as<toml::table>(section);
    if (of_section == nullptr) {
      problems_.push_back({line, fmt::format("there are no presets of [{}]; expected one of [{}]",
                                             section, fmt::join(names_in(&*presets), "] ["))});
      return;
    }
    const toml::table* preset = of_section->get_as<toml::table>(name);
    if (preset == nullptr) {
      problems_.push_back({line, fmt::format("unknown preset {}.{}; expected one of {}", section,
                                             name, fmt::join(names_in(of_section), " "))});
      return;
    }
    read_table(*preset, section, MissingKeys::kKeepDefault, params, problems_, {"title", "source"});
  }

  static std::vector<std::string> names_in(const toml::table* table) {
    std::vector<std::string> names;
    if (table == nullptr) return names;
    for (const auto& [key, value] : *table) names.emplace_back(key.str());
    return names;
  }

  void problem(const toml::node& node, std::string text) {
    problems_.push_back({node.source().begin.line, std::move(text)});
  }

  fs::path path_;
  SensorPreset preset_;
  const toml::table* document_ = nullptr;
  std::vector<std::string> known_;
  std::vector<TomlProblem> problems_;
};

}  // namespace

Result<Scenario> read_scenario(const fs::path& path) { return ScenarioReader(path).read({}, 0); }

Result<Scenario> read_scenario(const fs::path& path, const SensorPreset& preset) {
  return ScenarioReader(path, preset).read({}, 0);
}

bool has_presets(const std::string& section) {
  const Result<toml::table> presets = parse_toml(presets_path());
  return presets && presets->contains(section);
}

}  // namespace corridor::simulation
