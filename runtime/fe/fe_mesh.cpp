#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "railtab/runtime/base/text_lines.hpp"
#include "railtab/runtime/fe/fe_files.hpp"

namespace railtab {

namespace {

constexpr std::string_view comma = ",";

void add_node(const LineReader& reader, int node, const Eigen::Vector3d& position, FeMesh& mesh) {
  if (node < 1) throw reader.error(fmt::format("node {}", node), "a number from 1");
  if (!mesh.nodes.emplace(node, position).second) throw reader.error(fmt::format("node {} again", node), "each once");
}

/// "*NODE, NSET=ALL": the keyword and its parameters, in capitals and without blanks.
struct Keyword {
  std::string name;
  std::map<std::string, std::string> parameters;
};

Keyword keyword_of(std::string_view line) {
  Keyword keyword;
  std::array<std::string_view, 16> parts;
  std::size_t count = 0;
  for (std::size_t begin = 1; begin <= line.size() && count < parts.size(); ++count) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    parts[count] = stripped(line.substr(begin, end - begin));
    begin = end + 1;
  }
  keyword.name = upper_case(parts[0]);
  for (std::size_t i = 1; i < count; ++i) {
    const std::size_t equal = std::min(parts[i].find('='), parts[i].size());
    keyword.parameters[upper_case(stripped(parts[i].substr(0, equal)))] =
        equal < parts[i].size() ? std::string(stripped(parts[i].substr(equal + 1))) : std::string();
  }
  return keyword;
}

class DeckReader {
 public:
  explicit DeckReader(FeMesh& mesh) : mesh_(mesh) {}

  void read(const std::filesystem::path& file, int depth) {
    LineReader reader(file, "a finite-element input deck");
    block_ = Block::other;
    while (reader.next()) {
      const std::string_view line = stripped(reader.line());
      if (line.empty() || line.starts_with("**")) continue;
      if (line.starts_with('*')) {
        start(reader, keyword_of(line), file, depth);
      } else if (block_ == Block::node) {
        node(reader, line);
      } else if (block_ == Block::set) {
        members(reader, line);
      } else if (block_ == Block::element) {
        element(line);
      } else if (block_ == Block::instance) {
        instance(reader, line);
      }
    }
  }

 private:
  enum class Block { other, node, set, element, instance };

  void start(const LineReader& reader, const Keyword& keyword, const std::filesystem::path& file, int depth) {
    block_ = Block::other;
    const auto name = keyword.parameters.find("NSET");
    const auto system = keyword.parameters.find("SYSTEM");
    const bool turned =
        keyword.name == "NODE" && system != keyword.parameters.end() && upper_case(system->second) != "R";
    if (keyword.name == "SYSTEM" || turned) {
      throw reader.error(fmt::format("*{} with a coordinate system of its own", keyword.name),
                         "coordinates x, y, z along the model's axes");
    }
    if (keyword.name == "NODE") {
      block_ = Block::node;
      set_ = name == keyword.parameters.end() ? nullptr : &mesh_.sets[upper_case(name->second)];
    } else if (keyword.name == "NSET") {
      if (name == keyword.parameters.end()) throw reader.error("*NSET without a name", "*NSET, NSET=NAME");
      block_ = Block::set;
      set_ = &mesh_.sets[upper_case(name->second)];
      generate_ = keyword.parameters.contains("GENERATE");
    } else if (keyword.name == "ELEMENT") {
      block_ = Block::element;
      element_goes_on_ = false;
    } else if (keyword.name == "INSTANCE") {
      block_ = Block::instance;
    } else if (keyword.name == "TRANSFORM") {
      if (mesh_.turned.empty()) mesh_.turned = reader.place();
    } else if (keyword.name == "INCLUDE") {
      const auto input = keyword.parameters.find("INPUT");
      if (input == keyword.parameters.end()) throw reader.error("*INCLUDE without a file", "*INCLUDE, INPUT=FILE");
      constexpr int deepest = 10;
      if (depth >= deepest) throw reader.error("files that include each other", "at most ten levels of *INCLUDE");
      read(file.parent_path() / input->second, depth + 1);
      block_ = Block::other;
    }
  }

  void node(const LineReader& reader, std::string_view line) {
    std::array<std::string_view, 4> words;
    const std::size_t count = split(line, words, comma);
    if (count < 2 || count > 4) throw reader.error(fmt::format("'{}'", line.substr(0, 80)), "node, x, y, z");
    const int number = reader.number<int>(words[0], "the number of a node");
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    for (std::size_t k = 1; k < count; ++k) {
      position[static_cast<Eigen::Index>(k - 1)] = reader.number<double>(words[k], "a coordinate");
    }
    add_node(reader, number, position, mesh_);
    if (set_) set_->push_back(number);
  }

  /// An element with many nodes goes on after a line that ends with a comma.
  void element(std::string_view line) {
    if (!element_goes_on_) ++*mesh_.elements;
    element_goes_on_ = line.ends_with(',');
  }

  /// Abaqus's shift and turn of a part in its assembly.
  static void instance(const LineReader& reader, std::string_view line) {
    std::array<std::string_view, 7> words;
    const std::size_t count = std::min(split(line, words, comma), words.size());
    for (std::size_t k = 0; k < count; ++k) {
      if (reader.number<double>(words[k], "a shift of the *INSTANCE") == 0.0) continue;
      throw reader.error("an *INSTANCE that is moved",
                         "an input without parts and assemblies, or parts at their places");
    }
  }

  void members(const LineReader& reader, std::string_view line) {
    std::array<std::string_view, 64> words;
    const std::size_t count = split(line, words, comma);
    if (count > words.size()) throw reader.error("more than 64 words", "a line of a node set");
    if (generate_) {
      const int first = reader.number<int>(words[0], "the first node");
      const int last = count > 1 ? reader.number<int>(words[1], "the last node") : first;
      const int step = count > 2 ? reader.number<int>(words[2], "a step") : 1;
      if (first < 1 || step < 1 || last < first) {
        throw reader.error(fmt::format("'{}'", line.substr(0, 80)), "first, last, step");
      }
      const int members = (last - first) / step + 1;
      require_room(reader, static_cast<std::size_t>(members));
      for (int n = 0; n < members; ++n) set_->push_back(first + n * step);
      return;
    }
    for (std::size_t k = 0; k < count; ++k) {
      int number = 0;
      if (parse(words[k], number)) {
        require_room(reader, 1);
        set_->push_back(number);
        continue;
      }
      const auto other = mesh_.sets.find(upper_case(words[k]));
      if (other == mesh_.sets.end()) throw reader.error(fmt::format("'{}'", words[k]), "a node, or a set known by now");
      const std::vector<int> copy = other->second;
      require_room(reader, copy.size());
      set_->insert(set_->end(), copy.begin(), copy.end());
    }
  }

  /// Sets may name each other, and so grow from line to line without an end.
  void require_room(const LineReader& reader, std::size_t more) {
    constexpr std::size_t most = 20'000'000;
    members_ += more;
    if (members_ > most) throw reader.error("sets of more nodes", fmt::format("at most {} in all", most));
  }

  FeMesh& mesh_;
  std::size_t members_ = 0;  // of all sets
  Block block_ = Block::other;
  std::vector<int>* set_ = nullptr;
  bool generate_ = false, element_goes_on_ = false;
};

void read_table(LineReader& reader, FeMesh& mesh) {
  do {
    const std::string_view line = stripped(reader.line());
    if (line.empty() || line.front() == '#' || line.front() == '!' || line.front() == '%') continue;
    std::array<std::string_view, 7> words;
    const std::size_t count = split(line, words, comma);
    if (count > words.size()) throw reader.error(fmt::format("{} columns", count), "node, x, y, z");
    const int node = reader.number<int>(words[0], "the number of a node");
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    for (std::size_t k = 1; k < count; ++k) {
      const auto value = reader.number<double>(words[k], "a coordinate");
      if (k <= 3) {
        position[static_cast<Eigen::Index>(k - 1)] = value;
      } else if (value != 0.0) {
        throw reader.error(fmt::format("node {} with axes turned by {} degrees", node, value),
                           "nodes whose motions are along the model's axes");
      }
    }
    add_node(reader, node, position, mesh);
  } while (reader.next());
}

}  // namespace

FeMesh read_fe_mesh(const std::filesystem::path& file) {
  FeMesh mesh;
  LineReader reader(file, "nodes of a mesh");
  while (reader.next()) {
    const std::string_view line = stripped(reader.line());
    if (line.empty() || line.front() == '#' || line.front() == '!' || line.front() == '%') continue;
    if (line.front() == '*') {
      mesh.elements = 0;
      DeckReader(mesh).read(file, 0);
    } else {
      read_table(reader, mesh);
    }
    break;
  }
  if (mesh.nodes.empty()) throw reader.file_error("no node", "*NODE, or a table of node, x, y, z");
  for (const auto& [name, members] : mesh.sets) {
    for (int node : members) {
      if (mesh.nodes.contains(node)) continue;
      throw reader.file_error(fmt::format("node {} in the set {}", node, name), "nodes with coordinates");
    }
  }
  return mesh;
}

}  // namespace railtab
