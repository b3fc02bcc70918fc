#pragma once

#include "graspfit/geometry/triangle_mesh.hpp"

/// \file
/// Closed, outward, manifold meshes of everyday things, built in code. Every dimension is in meters
/// and has the value of a real object as its default; the frame's z axis points up.
///
/// Turned shapes (bottle, bowling pin, flower pot) have their vertices on the exact profile turned
/// around z, with `segments` (a multiple of 4 from 12 to 2048) vertices in a ring, fewer near the
/// axis. Blended shapes (mug, bowling ball, octopus, wire cage) are the zero level of distance
/// functions: vertices lie on it to 1e-12 of the longest extent, and faces have angles above 25
/// degrees at the default dimensions. Where two solids meet, the edge is filled or rounded with
/// about the stated radius; points of the surface farther than that radius from one solid lie
/// exactly on the other.
///
/// Bounding boxes are those of the exact shapes, to rounding, however few the segments. Surfaces
/// and volumes converge with the square of the edge length. The same arguments give the same bytes,
/// on one build and processor.
/// All throw InvalidInput that names the field and its value: for a dimension that is not positive
/// or does not fit the others, for segments out of range, and where edges are too long for the
/// features of a blended shape (its topology is checked) or too many.

namespace graspfit::geometry {

/// A filled bottle (nothing inside), standing on z = 0, axis z. Default: a 0.75 l wine bottle.
struct BottleDimensions {
  double height = 0.300;           ///< z of the mouth.
  double body_diameter = 0.0745;   ///< Diameter of the body, the widest part.
  double neck_diameter = 0.0290;   ///< Diameter of the straight neck, less than body_diameter.
  double shoulder_bottom = 0.185;  ///< z where the lines of body and shoulder meet.
  double shoulder_top = 0.220;     ///< z where the lines of shoulder and neck meet.
  double shoulder_radius = 0.055;  ///< Radius of the arcs that round the corners at shoulder_bottom
                                   ///< and shoulder_top.
  double base_radius = 0.005;      ///< Rounding of the bottom edge.
  double lip_radius = 0.003;       ///< Rounding of the edge of the mouth.
  void validate() const;           ///< Throws InvalidInput.
};

/// `segments` vertices around; edges along the profile are at most about as long as those around
/// the body.
TriangleMesh bottle(const BottleDimensions& dimensions = {}, int segments = 96);

/// A ten-pin bowling pin standing on z = 0, axis z, with the diameters of the drawing in the
/// [USBC Equipment Specifications]: 2.031 in at the base, 2.828 at a height of 0.75 in, 3.906 at
/// 2.25, 4.510 at 3.375, 4.766 at 4.5 (the belly, its widest), 4.563 at 5.875, 3.703 at 7.25, 2.472
/// at 8.625, 1.965 at 9.375, 1.797 at 10 (the neck), 1.870 at 10.875, 2.094 at 11.75, 2.406 at
/// 12.625, 2.547 at 13.5 (the head), with a top of radius 1.273 in and a bottom edge of radius
/// 5/32 in. Published pages confirm height, base, belly, neck and head; the rest are the figures
/// commonly quoted, not compared with the drawing itself. Cubic splines interpolate these
/// diameters, with slope zero at belly, neck and head. The cup in the base is left out, and the
/// base's diameter is where the sides would meet the floor without the rounding.
struct BowlingPinDimensions {
  double height = 0.381;  ///< 15 in; all the rest scales with it.
  void validate() const;  ///< Throws InvalidInput.
};

/// `segments` vertices around; edges along the profile are at most about as long as those around
/// the belly.
TriangleMesh bowling_pin(const BowlingPinDimensions& dimensions = {}, int segments = 96);

/// A hollow flower pot without a drain hole, standing on z = 0, axis z: a conical wall that is
/// equally thick at every height and ends in a cylindrical collar.
struct FlowerPotDimensions {
  double height = 0.130;
  double top_diameter = 0.150;    ///< Outer diameter of the collar.
  double base_diameter = 0.100;   ///< Where wall and floor would meet outside without rounding.
  double wall_thickness = 0.006;  ///< Thickness of the wall, measured horizontally, and of the
                                  ///< floor.
  double rim_height = 0.030;      ///< Height of the collar.
  double rim_thickness = 0.010;   ///< Thickness of the collar at the top, more than wall_thickness.
  double edge_radius = 0.0018;    ///< Rounding of all edges.
  void validate() const;          ///< Throws InvalidInput.
};

/// `segments` vertices around; arcs get at least eight edges a half turn.
TriangleMesh flower_pot(const FlowerPotDimensions& dimensions = {}, int segments = 120);

/// A hollow mug standing on z = 0, axis z, with a handle towards +x. The wall is all that lies
/// within half of wall_thickness of a sheet, a flat floor that turns up into a cylinder, so that
/// its rim is round. The handle is a round bar along a rectangle with rounded corners, at half
/// height. Genus 1.
struct MugDimensions {
  double height = 0.095;
  double diameter = 0.082;          ///< Outside, without the handle.
  double wall_thickness = 0.005;    ///< Thickness of the wall and of the floor.
  double base_radius = 0.010;       ///< Outer radius of the bottom edge, at least wall_thickness.
  double handle_height = 0.064;     ///< From the handle's lowest to its highest point.
  double handle_clearance = 0.027;  ///< Gap between wall and handle for the fingers.
  double handle_thickness = 0.011;  ///< Diameter of the handle's bar.
  double handle_radius = 0.024;     ///< Of the corners of the bar's center line.
  double fillet = 0.004;            ///< Radius between wall and handle.
  void validate() const;            ///< Throws InvalidInput.
};

/// Edges are about 1/`segments` of the outer circumference long. The mug extends in x from
/// −diameter/2 to diameter/2 + handle_clearance + handle_thickness.
TriangleMesh mug(const MugDimensions& dimensions = {}, int segments = 150);

/// A bowling ball centered at the origin with three blind holes with round ends around +z: a thumb
/// hole at −x that points to the center, two parallel finger holes at +x, with the center halfway
/// between their axes. Symmetric about y = 0. Default: 8.5 in [USBC Equipment Specifications].
struct BowlingBallDimensions {
  double diameter = 0.2159;
  double finger_diameter = 0.025;
  double finger_depth = 0.060;    ///< Along the axis, from the ball's surface to the hole's end.
  double finger_spacing = 0.034;  ///< Between the axes of the finger holes.
  double thumb_diameter = 0.028;
  double thumb_depth = 0.070;  ///< As finger_depth.
  double span = 0.095;  ///< Chord of the ball between the axis of the thumb hole and the point
                        ///< halfway between the axes of the finger holes.
  double edge_radius = 0.004;  ///< Rounding of the holes' edges.
  void validate() const;       ///< Throws InvalidInput.
};

/// Edges are about 1/`segments` of the circumference long.
TriangleMesh bowling_ball(const BowlingBallDimensions& dimensions = {}, int segments = 220);

/// An octopus on z = 0: a capsule-shaped mantle around the z axis and eight arms in the directions
/// k · 45° from +x. The center line of an arm is an arc of a circle in the plane through the z
/// axis: it starts inside the mantle, at a third of the mantle's radius from the axis, heading 55°
/// downward, and ends heading 35° upward. The arm's radius falls linearly along the center line
/// from root to tip. Genus 0, symmetric in x, y and x = y.
struct OctopusDimensions {
  double height = 0.160;  ///< z of the top of the mantle.
  double mantle_diameter = 0.090;
  double mantle_height = 0.110;  ///< From the mantle's lowest to its highest point; more than
                                 ///< mantle_diameter.
  double arm_reach = 0.180;      ///< From the z axis to the end of an arm.
  double arm_root_diameter = 0.028;
  double arm_tip_diameter = 0.012;  ///< Less than at the root.
  double fillet = 0.006;            ///< Radius between arms and mantle.
  void validate() const;            ///< Throws InvalidInput.
};

/// Edges are about 1/`segments` of the mantle's circumference long.
TriangleMesh octopus(const OctopusDimensions& dimensions = {}, int segments = 100);

/// A cage of round bars on z = 0 around the z axis: a frame of two rectangles with rounded corners,
/// one below and one above, with bars_per_side thinner bars between them on each of the four sides,
/// and bars_per_side bars across each rectangle, along y. Genus 6 bars_per_side + 1.
struct WireCageDimensions {
  double width = 0.160;   ///< Along x, outside.
  double depth = 0.120;   ///< Along y, outside.
  double height = 0.120;  ///< Along z, outside.
  double frame_diameter = 0.009;
  double bar_diameter = 0.0055;  ///< At least 2 fillet less than frame_diameter.
  double corner_radius = 0.020;  ///< Of the corners of the frame's center line.
  double fillet = 0.0015;        ///< Radius between bars and frame.
  int bars_per_side = 3;         ///< 1 to 50, at equal distances.
  void validate() const;         ///< Throws InvalidInput.
};

/// Edges are about 1/`segments` of a bar's circumference long.
TriangleMesh wire_cage(const WireCageDimensions& dimensions = {}, int segments = 10);

/// An open box around the z axis to pick things out of, five walls with sharp edges: a floor whose
/// upper side is at z = 0, so that what stands on z = 0 stands in the bin, and four sides. Its 92
/// faces have corners that are exact to rounding. Genus 0. Default: about the inside of a Euro
/// container (small load carrier) with a footprint of 400 mm x 300 mm, without ribs and rim.
struct BinDimensions {
  double inner_length = 0.346;    ///< Along x, between the walls.
  double inner_width = 0.265;     ///< Along y, between the walls.
  double inner_height = 0.120;    ///< From the floor's upper side to the rim.
  double wall_thickness = 0.003;  ///< Thickness of the four sides and of the floor.
  void validate() const;          ///< Throws InvalidInput.
};

TriangleMesh bin(const BinDimensions& dimensions = {});

/// A table on z = 0 around the z axis: a box on four square legs, all edges sharp, 172 faces whose
/// corners are exact to rounding. Genus 0.
struct TableDimensions {
  double length = 1.20;  ///< Along x.
  double width = 0.70;   ///< Along y.
  double height = 0.74;
  double top_thickness = 0.03;
  double leg_width = 0.06;
  double leg_inset = 0.04;  ///< From the edges of the top to the legs.
  void validate() const;    ///< Throws InvalidInput.
};

TriangleMesh table(const TableDimensions& dimensions = {});

}  // namespace graspfit::geometry
