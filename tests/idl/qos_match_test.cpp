#include "idl/qos_match.hpp"

#include <catch2/catch.hpp>

#include "idl/qos.hpp"
#include "idl/topic_catalog.hpp"

// The rules are those of the DDS specification 1.4, 2.2.3: a reader may request no more than the
// writer offers, and both need a partition in common and the same ownership.
namespace mpm::idl {
namespace {

Qos plain() { return Qos(dds_create_qos()); }

using Texts = std::vector<std::string>;

}  // namespace

TEST_CASE("our own profiles match each other") {
  for (const KnownTopic& topic : known_topics())
    for (const WriterPace pace : {WriterPace::kRealTime, WriterPace::kLossless})
      CHECK(incompatible_policies(topic.writer_qos(pace).get(), topic.reader_qos().get()).empty());
  CHECK(incompatible_policies(health_qos().get(), neighbour_health_qos().get()).empty());
}

TEST_CASE("each policy that does not match is named, and only in the direction that matters") {
  const Qos defaults = plain();
  const Qos other = plain();
  std::string expected;
  bool both_ways = false;
  SECTION("reliability") {
    dds_qset_reliability(other.get(), DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    expected = "RELIABILITY (best effort offered, reliable requested)";
  }
  SECTION("durability") {
    dds_qset_durability(other.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
    expected = "DURABILITY (volatile offered, transient local requested)";
  }
  SECTION("deadline") {
    dds_qset_deadline(other.get(), DDS_MSECS(1500));
    expected = "DEADLINE (none offered, 1.5 s requested)";
  }
  SECTION("ownership") {
    dds_qset_ownership(other.get(), DDS_OWNERSHIP_EXCLUSIVE);
    expected = "OWNERSHIP (shared offered, exclusive requested)";
    both_ways = true;
  }
  SECTION("liveliness") {
    dds_qset_liveliness(other.get(), DDS_LIVELINESS_AUTOMATIC, DDS_SECS(1));
    expected = "LIVELINESS (automatic, lease none offered, automatic, lease 1 s requested)";
  }
  SECTION("destination order") {
    dds_qset_destination_order(other.get(), DDS_DESTINATIONORDER_BY_SOURCE_TIMESTAMP);
    expected = "DESTINATION_ORDER (by reception offered, by source time requested)";
  }
  SECTION("partition") {
    const char* name = "plant-a";
    dds_qset_partition(other.get(), 1, &name);
    expected = "PARTITION ('' offered, 'plant-a' requested)";
    both_ways = true;
  }
  CHECK(incompatible_policies(defaults.get(), other.get()) == Texts{expected});
  CHECK(incompatible_policies(other.get(), defaults.get()).empty() == !both_ways);
  CHECK(incompatible_policies(other.get(), other.get()).empty());
}

TEST_CASE("partitions may have wildcards") {
  const Qos writer = plain();
  const Qos reader = plain();
  const char* name = "plant.7";
  const char* pattern = "plant.*";
  dds_qset_partition(writer.get(), 1, &name);
  dds_qset_partition(reader.get(), 1, &pattern);
  CHECK(incompatible_policies(writer.get(), reader.get()).empty());
}

}  // namespace mpm::idl
