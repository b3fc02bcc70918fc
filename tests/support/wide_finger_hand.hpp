#pragma once

#include <string>

/// \file
/// A hand whose neighboring fingertips are wide and close, as a description.

namespace graspfit::testing {

/// One finger of `wide_finger_hand_urdf`: four joints, of which the first and the last two bend and
/// the second turns the finger aside. It points along +y of its base, whose pose in the palm's
/// frame is given as URDF has it, and closes toward +z.
inline std::string wide_finger(const std::string& name, const std::string& xyz,
                               const std::string& rpy) {
  const auto link = [&](const std::string& part, const std::string& center,
                        const std::string& size) {
    return "  <link name=\"" + name + '_' + part + "\"><collision><origin xyz=\"" + center +
           "\"/><geometry><box size=\"" + size + "\"/></geometry></collision></link>\n";
  };
  const auto joint = [&](const std::string& part, const std::string& parent,
                         const std::string& child, const std::string& origin,
                         const std::string& axis, const std::string& limits) {
    return "  <joint name=\"" + name + '_' + part + "\" type=\"revolute\"><parent link=\"" +
           parent + "\"/><child link=\"" + name + '_' + child + "\"/><origin " + origin +
           "/><axis xyz=\"" + axis + "\"/><limit " + limits +
           " effort=\"1\" velocity=\"1\"/></joint>\n";
  };
  return link("knuckle", "0 0.006 0", "0.020 0.012 0.020") +
         link("proximal", "0 0.022 0", "0.022 0.036 0.020") +
         link("middle", "0 0.018 0", "0.022 0.032 0.020") +
         link("tip", "0 0.022 0", "0.030 0.040 0.018") +
         joint("flex", "palm", "knuckle", "xyz=\"" + xyz + "\" rpy=\"" + rpy + '"', "1 0 0",
               "lower=\"-0.3\" upper=\"2.0\"") +
         joint("side", name + "_knuckle", "proximal", "xyz=\"0 0.014 0\"", "0 0 1",
               "lower=\"-1.0\" upper=\"1.0\"") +
         joint("middle", name + "_proximal", "middle", "xyz=\"0 0.042 0\"", "1 0 0",
               "lower=\"-0.4\" upper=\"1.9\"") +
         joint("distal", name + "_middle", "tip", "xyz=\"0 0.036 0\"", "1 0 0",
               "lower=\"-0.3\" upper=\"2.0\"");
}

/// Four equal fingers, three beside one another at 45 mm and one opposite, with tips 30 mm wide and
/// abduction after the first flexion, as on the LEAP hand: neighbors cross when they swing.
inline std::string wide_finger_hand_urdf() {
  return "<?xml version=\"1.0\"?>\n<robot name=\"wide_fingers\">\n"
         "  <link name=\"palm\"><collision><origin xyz=\"0 0 -0.005\"/><geometry>"
         "<box size=\"0.115 0.100 0.020\"/></geometry></collision></link>\n" +
         wide_finger("left", "-0.045 0.055 0", "0 0 0") +
         wide_finger("middle", "0 0.055 0", "0 0 0") +
         wide_finger("right", "0.045 0.055 0", "0 0 0") +
         wide_finger("thumb", "0 -0.055 0", "0 0 3.141592653589793") + "</robot>\n";
}

}  // namespace graspfit::testing
