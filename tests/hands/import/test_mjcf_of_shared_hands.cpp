#include "hands/mjcf_reading.hpp"

namespace test_mjcf_of_shared_hands {

namespace {

using namespace graspfit;
using namespace graspfit::testing;

/// Sets the decimals that MuJoCo's XML writer keeps, while it lives. The library exports the
/// setting for its own tests and declares it nowhere; where it is not there, nothing changes.
class WriterDigits {
 public:
  explicit WriterDigits(int digits) {
    if (set_ != nullptr && get_ != nullptr) {
      before_ = get_();
      set_(digits);
      is_set_ = true;
    }
  }
  ~WriterDigits() {
    if (is_set_) set_(before_);
  }
  WriterDigits(const WriterDigits&) = delete;
  WriterDigits& operator=(const WriterDigits&) = delete;

  bool is_set() const { return is_set_; }

 private:
  void (*set_)(int) = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT,
                                                            "_mjPRIVATE__set_xml_precision"));
  int (*get_)() = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "_mjPRIVATE__get_xml_precision"));
  int before_ = 0;
  bool is_set_ = false;
};

/// Writes `urdf` beside itself as MuJoCo writes it, `hand.xml`. What MuJoCo refuses of the shared
/// hands is told to it or changed first: paths of meshes are kept; links without mass get some,
/// which moving bodies must have; the visual geometry goes, since two mesh files of one name
/// (visual and collision) are one to MuJoCo.
fs::path converted_by_mujoco(const fs::path& urdf, bool fuses) {
  tinyxml2::XMLDocument document;
  REQUIRE(document.LoadFile(urdf.c_str()) == tinyxml2::XML_SUCCESS);
  tinyxml2::XMLElement* robot = document.RootElement();
  for (auto* link = robot->FirstChildElement("link"); link;
       link = link->NextSiblingElement("link")) {
    while (auto* visual = link->FirstChildElement("visual")) link->DeleteChild(visual);
    tinyxml2::XMLElement* inertial = link->FirstChildElement("inertial");
    if (inertial && inertial->FirstChildElement("mass")->DoubleAttribute("value") > 0.0) continue;
    if (inertial) link->DeleteChild(inertial);
    inertial = link->InsertNewChildElement("inertial");
    inertial->InsertNewChildElement("mass")->SetAttribute("value", 1e-3);
    tinyxml2::XMLElement* inertia = inertial->InsertNewChildElement("inertia");
    for (const char* entry : {"ixx", "iyy", "izz"}) inertia->SetAttribute(entry, 1e-6);
    for (const char* entry : {"ixy", "ixz", "iyz"}) inertia->SetAttribute(entry, 0.0);
  }
  tinyxml2::XMLElement* compiler = document.NewElement("compiler");
  compiler->SetAttribute("strippath", "false");
  compiler->SetAttribute("fusestatic", fuses ? "true" : "false");
  compiler->SetAttribute("balanceinertia", "true");
  tinyxml2::XMLElement* extension = document.NewElement("mujoco");
  extension->InsertEndChild(compiler);
  robot->InsertFirstChild(extension);
  const fs::path readable = urdf.parent_path() / "for_mujoco.urdf";
  REQUIRE(document.SaveFile(readable.c_str()) == tinyxml2::XML_SUCCESS);
  std::array<char, 1000> error{};
  mjModel* model = mj_loadXML(readable.c_str(), nullptr, error.data(), 1000);
  CAPTURE(error.data());
  REQUIRE(model != nullptr);
  const fs::path xml = urdf.parent_path() / "hand.xml";
  const bool is_saved = mj_saveLastXML(xml.c_str(), model, error.data(), 1000) == 1;
  mj_deleteModel(model);
  REQUIRE(is_saved);
  return xml;
}

TEST_CASE("MJCF: what MuJoCo writes of each shared URDF stands as the URDF does", "[hands][mjcf]") {
  struct Hand {
    std::string urdf;
    std::size_t links;  ///< Number of links of the same name when fixed ones are kept.
    std::size_t fused;  ///< The same when MuJoCo fuses them with their parents.
  };
  // The counts are the movable joints of SOURCES.md in the data folder; each moves one link, which
  // fusing keeps.
  const std::vector<Hand> all = {{"robotiq_2f_85/robotiq_2f_85.urdf", 12, 6},
                                 {"panda_gripper/franka_panda.urdf", 4, 2},
                                 {"barrett_hand/bhand_model.urdf", 9, 8},
                                 {"barrett_graspit/Barrett.urdf", 27, 8},
                                 {"human_hand_20dof/HumanHand.urdf", 45, 20},
                                 {"shadow_hand/shadow_hand_right.urdf", 32, 24},
                                 {"allegro_hand/allegro_hand_right.urdf", 23, 16}};
  struct Digits {
    int digits;
    double tolerance;
    int configurations;
  };
  // MuJoCo writes 6 significant digits unless told otherwise: this is 5e-7 of each number, and some
  // ten of them, quaternions included, are between the palm and a fingertip. Measured was 1.5e-6.
  for (const Digits writer : {Digits{17, 1e-9, 1000}, Digits{6, 1e-5, 100}}) {
    const WriterDigits digits(writer.digits);
    if (writer.digits == 17 && !digits.is_set()) continue;
    for (const Hand& hand : all) {
      const auto found = testing::find_data("hands/" + hand.urdf);
      if (!found) {
        GRASPFIT_SKIP_TEST("hands/" + hand.urdf + " is not in the data folder; set GRASPFIT_DATA");
      }
      const fs::path source = *found;
      for (const bool fuses : {false, true}) {
        CAPTURE(hand.urdf, fuses, writer.digits);
        const TemporaryFolder folder;
        fs::copy(source.parent_path(), folder.path(),
                 fs::copy_options::recursive | fs::copy_options::overwrite_existing);
        const fs::path urdf = folder.path() / source.filename();
        const fs::path xml = converted_by_mujoco(urdf, fuses);
        const RobotDescription robot = read(xml).robot;
        Findings findings(Findings::AtFault::Throw);
        const RobotDescription original =
            hands::internal::parse_urdf(base::read_file(source), source.string(), findings);
        base::Random random(3);
        double largest = 0.0;
        for (int i = 0; i < writer.configurations; ++i) {
          const Positions q = random_positions(original, random);
          Poses expected = link_poses(original, q);
          // A fixed link above a body without joints is the world's, and not kept.
          if (const auto root = expected.find(robot.links[0].name); root != expected.end()) {
            const RigidTransform X_RO = root->second.inverse();
            for (auto& [name, X] : expected) X = X_RO * X;
          }
          largest = std::max(largest, largest_difference(link_poses(robot, q), expected,
                                                         fuses ? hand.fused : hand.links));
        }
        CHECK(largest < writer.tolerance);
      }
    }
  }
}

}  // namespace

}  // namespace test_mjcf_of_shared_hands
