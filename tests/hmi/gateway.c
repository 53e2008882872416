/* gateway DOMAIN UNIT SAMPLES PERIOD_MS: plays the control system of a unit with MVs u1, u2 and CV
 * y1: says its layout once, then what was measured in each control interval. A real gateway reads
 * the values from the control system where this one makes them up. */
#include <dds/dds.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "mpm.h"

static dds_entity_t writer_of(dds_entity_t participant, const dds_topic_descriptor_t* type,
                              const char* name, dds_durability_kind_t durability, int depth) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(10));
  dds_qset_durability(qos, durability);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, depth); /* such a writer never waits */
  const dds_entity_t topic = dds_create_topic(participant, type, name, NULL, NULL);
  const dds_entity_t writer = dds_create_writer(participant, topic, qos, NULL);
  dds_delete_qos(qos);
  if (writer < 0) {
    fprintf(stderr, "%s: %s\n", name, dds_strretcode(writer));
    exit(2);
  }
  return writer;
}

static void write_layout(dds_entity_t writer, char* unit, char* kind, char** tags,
                         char** engineering_units, uint32_t count) {
  const mpm_Layout layout = {.unit = unit,
                             .kind = kind,
                             .sample_time_s = 1.0,
                             .tags = {count, count, tags, false},
                             .engineering_units = {count, count, engineering_units, false}};
  dds_write(writer, &layout);
}

static void write_values(dds_entity_t writer, char* unit, long long interval, dds_time_t time,
                         double* values, uint32_t count) {
  const mpm_Sample sample = {.unit = unit,
                             .interval = interval,
                             .source_time_ns = time, /* ns of UTC since 1970 */
                             .values = {count, count, values, false},
                             .quality = {0, 0, NULL, false}}; /* empty: all are good */
  dds_write(writer, &sample);
}

/* What is written before a reader is known is lost to it. */
static void wait_for_reader(dds_entity_t writer) {
  dds_publication_matched_status_t status = {0};
  const dds_time_t end = dds_time() + DDS_SECS(10);
  while (dds_time() < end && status.current_count == 0) {
    dds_get_publication_matched_status(writer, &status);
    dds_sleepfor(DDS_MSECS(10));
  }
  dds_sleepfor(DDS_MSECS(200)); /* and the reader has to know the writer */
}

int main(int argc, char** argv) {
  if (argc != 5) {
    fprintf(stderr, "usage: gateway DOMAIN UNIT SAMPLES PERIOD_MS\n");
    return 3;
  }
  char* unit = argv[2];
  const dds_entity_t participant =
      dds_create_participant((dds_domainid_t)strtoul(argv[1], NULL, 10), NULL, NULL);
  if (participant < 0) {
    fprintf(stderr, "participant: %s\n", dds_strretcode(participant));
    return 2;
  }
  const dds_entity_t layout =
      writer_of(participant, &mpm_Layout_desc, "mpm/layout", DDS_DURABILITY_TRANSIENT_LOCAL, 1);
  const dds_entity_t mv =
      writer_of(participant, &mpm_Sample_desc, "mpm/mv", DDS_DURABILITY_VOLATILE, 256);
  const dds_entity_t cv =
      writer_of(participant, &mpm_Sample_desc, "mpm/cv", DDS_DURABILITY_VOLATILE, 256);
  char *mv_tags[] = {"u1", "u2"}, *mv_units[] = {"%", "%"};
  char *cv_tags[] = {"y1"}, *cv_units[] = {"degC"};
  write_layout(layout, unit, "mv", mv_tags, mv_units, 2);
  write_layout(layout, unit, "cv", cv_tags, cv_units, 1);
  wait_for_reader(mv);
  wait_for_reader(cv);

  const double pole = exp(-1.0 / 5.0);
  double u[2] = {0.0, 0.0}, y = 0.0;
  const long samples = strtol(argv[3], NULL, 10), period_ms = strtol(argv[4], NULL, 10);
  srand(1);
  for (long long k = 1; k <= samples; ++k) {
    double measured = y + 0.1 * ((double)rand() / RAND_MAX - 0.5);
    y = pole * y + (1.0 - pole) * (4.0 * u[0] + u[1]); /* the model says 2 where this says 4 */
    for (int i = 0; i < 2; ++i)
      if (rand() % 10 == 0) u[i] = rand() % 2 == 0 ? 1.0 : -1.0;
    const dds_time_t now = dds_time();
    write_values(mv, unit, k, now, u, 2);
    write_values(cv, unit, k, now, &measured, 1);
    dds_sleepfor(DDS_MSECS(period_ms));
  }
  dds_wait_for_acks(mv, DDS_SECS(10));
  dds_wait_for_acks(cv, DDS_SECS(10));
  dds_delete(participant);
  return 0;
}
