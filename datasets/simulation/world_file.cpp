#include "datasets/simulation/scenario_params.hpp"
#include "datasets/simulation/toml_input.hpp"
#include "datasets/simulation/world.hpp"

namespace corridor::simulation {

Result<World> read_world(const std::filesystem::path& path) {
  const Result<toml::table> document = parse_toml(path);
  if (!document) return tl::make_unexpected(document.error());
  const toml::table* table = document->get_as<toml::table>("world");
  if (table == nullptr) {
    return fail(ErrorCode::kInvalid, "no [world] table", path.string(),
                "[world] with a_m b_m c_m alpha_deg doors_every_m");
  }
  std::vector<TomlProblem> problems;
  WorldParams params{};
  read_table(*table, "world", MissingKeys::kAreErrors, params, problems);
  if (problems.empty()) {
    for (std::string& line : violations(to_shape(params))) {
      problems.push_back({table->source().begin.line, std::move(line)});
    }
  }
  if (!problems.empty()) return tl::make_unexpected(to_error(path, problems));
  return make_corridor(to_shape(params));
}

}  // namespace corridor::simulation
