// Question: does the measure notice what it was made to notice: contact on a fragile part, contact
// at a finger's edge, contacts without a stable pair, an irregular polygon, one beside the center
// of mass?
//
// Answered by a row per set of contacts on a ball, built so that it differs from a good set in one
// respect, with M and every term of it. No planner is asked.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cells/planning_table.hpp"
#include "graspfit/contact/contact_quality.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/hands/hand_model.hpp"
#include "graspfit/sweep/setting_value.hpp"
#include "list/experiment_list.hpp"

namespace graspfit::experiments::internal {
namespace measured_contacts_parts {
namespace {

/// One contact of the set: where on the ball, and how it lies on its pad.
struct BallContact {
  Eigen::Vector3d direction;           ///< From the ball's center, unit.
  double boundary_distance_rel = 1.0;  ///< d over the pad's largest.
  double area_rel = 0.5;               ///< A over the pad's area.
  bool weak = false;
};

struct ContactSet {
  double radius = 0.0;  ///< Of the ball [m].
  std::string hand;     ///< Whose fingertip pads touch, one finger after the other.
  std::vector<BallContact> contacts;
};

std::vector<sweep::Column> own_settings() {
  return {{"radius_m", "m", "of the ball"},
          {"pads_of", "", "a shipped hand; its fingertip pads touch, one finger after the other"},
          {"contact_set", "",
           "array of {direction: [x, y, z], boundary_distance_rel, area_rel, weak}: where on the "
           "ball, d and A as shares of the pad's, whether that part is fragile"}};
}

double share(const base::JsonValue& value) {
  const double number = value.number();
  if (number < 0.0 || number > 1.0) value.refuse("must be in [0, 1]");
  return number;
}

ContactSet contact_set(const sweep::Cell& cell) {
  const nlohmann::json json = nlohmann::json::parse(cell.settings);
  for (const auto& [key, value] : json.items()) {
    bool is_known = false;
    for (const sweep::Column& setting : own_settings()) is_known = is_known || setting.name == key;
    if (!is_known)
      throw sweep::SettingError(key, "is no setting; there are radius_m, pads_of, contact_set");
  }
  ContactSet set;
  set.radius = sweep::setting(cell, "radius_m").positive_number();
  set.hand = sweep::setting(cell, "pads_of").name();
  for (const base::JsonValue& item : sweep::setting(cell, "contact_set").some_items()) {
    item.require_members({}, {"direction", "boundary_distance_rel", "area_rel", "weak"});
    BallContact contact;
    contact.direction = sweep::vector_of(item.at("direction"));
    if (!(contact.direction.norm() > 0.0)) item.at("direction").refuse("must not be zero");
    contact.direction.normalize();
    contact.boundary_distance_rel = share(item.at("boundary_distance_rel"));
    contact.area_rel = share(item.at("area_rel"));
    contact.weak = item.at("weak").flag();
    set.contacts.push_back(contact);
  }
  return set;
}

std::vector<sweep::Column> columns() {
  return {{"num_contacts", "1", "N'"},
          {"stable_pairs", "1", "m"},
          {"m1", "1", "M1"},
          {"m2", "1", "M2"},
          {"m3", "1", "M3"},
          {"regularity", "1", "R"},
          {"centroid_distance_m", "m", "D"},
          {"m", "1", "M"}};
}

std::vector<sweep::Column> details() {
  return {{"contact", "1", "from 0"},
          {"x_m", "m", "point on the ball, its center is 0"},
          {"y_m", "m", "of the same"},
          {"z_m", "m", "of the same"},
          {"boundary_distance", "1", "d as it enters M1"},
          {"area", "1", "A as it enters M1"},
          {"strength", "1", "S"},
          {"paired_with", "", "the contacts with which it is a stable pair"}};
}

std::vector<contact::Contact> contacts_on_pads(const ContactSet& set,
                                               const hands::HandModel& hand) {
  std::vector<contact::Contact> contacts;
  for (int i = 0; i < std::ssize(set.contacts); ++i) {
    if (i >= std::ssize(hand.fingers)) {
      throw base::InvalidInput("contact_set: hand " + set.hand + " has " +
                               std::to_string(hand.fingers.size()) + " fingers for " +
                               std::to_string(set.contacts.size()) + " contacts");
    }
    const int pad = *hand.fingers[i].tip_pad;
    const BallContact& given = set.contacts[i];
    contact::Contact contact;
    contact.point_O = set.radius * given.direction;
    contact.inward_normal_O = -given.direction;
    contact.area = given.area_rel * hands::pad_area(hand.pads[pad]);
    contact.pad_boundary_distance =
        given.boundary_distance_rel * hands::largest_boundary_distance(hand.pads[pad]);
    contact.link = hand.pads[pad].link;
    contact.pad = pad;
    contact.finger = i;
    contact.is_target = true;
    contact.weak = given.weak;
    contacts.push_back(contact);
  }
  return contacts;
}

sweep::CellResult run(const sweep::Cell& cell, const std::filesystem::path&) {
  const ContactSet set = contact_set(cell);
  const std::shared_ptr<const hands::HandModel> hand = load_hand(set.hand);
  const std::vector<contact::Contact> contacts = contacts_on_pads(set, *hand);
  const Eigen::Vector3d corner = Eigen::Vector3d::Constant(set.radius);
  const contact::ContactQuality quality = contact::contact_quality(
      contacts,
      {.normalizing_radius = contact::normalizing_radius({-corner, corner}), .hand = hand.get()});

  sweep::CellResult result{sweep::ResultRow(columns()),
                           sweep::ResultRow(std::vector<sweep::Column>())};
  result.row.set("num_contacts", field(contacts.size()));
  result.row.set("stable_pairs", field(quality.stable_pairs.size()));
  result.row.set("m1", quality.m1);
  result.row.set("m2", quality.m2);
  result.row.set("m3", quality.m3);
  result.row.set("regularity", quality.regularity);
  result.row.set("centroid_distance_m", quality.centroid_distance);
  result.row.set("m", quality.m);
  for (int i = 0; i < std::ssize(contacts); ++i) {
    sweep::ResultRow detail(details());
    detail.set("contact", field(i));
    detail.set("x_m", contacts[i].point_O.x());
    detail.set("y_m", contacts[i].point_O.y());
    detail.set("z_m", contacts[i].point_O.z());
    detail.set("boundary_distance", quality.terms[i].boundary_distance);
    detail.set("area", quality.terms[i].area);
    detail.set("strength", quality.terms[i].strength);
    std::string partners;
    for (const contact::StablePair& pair : quality.stable_pairs) {
      if (pair.first != i && pair.second != i) continue;
      partners += (partners.empty() ? "" : " ") +
                  std::to_string(pair.first == i ? pair.second : pair.first);
    }
    detail.set("paired_with", partners);
    result.details.push_back(std::move(detail));
  }
  return result;
}

}  // namespace
}  // namespace measured_contacts_parts

sweep::Experiment measured_contacts() {
  using namespace measured_contacts_parts;
  return {.slug = "measured_contacts",
          .columns = columns(),
          .settings = own_settings(),
          .details = details(),
          .check = [](const sweep::Cell& cell) { contact_set(cell); },
          .run = run,
          .inputs = [](const sweep::Cell&) { return std::vector<std::filesystem::path>(); }};
}

}  // namespace graspfit::experiments::internal
