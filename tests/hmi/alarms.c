/* alarms DOMAIN SECONDS: prints the alarms of all units, as they stand and as they change, and how
 * their monitors fare. Knows nothing of the monitor but mpm.idl. */
#include <dds/dds.h>
#include <stdio.h>
#include <stdlib.h>

#include "mpm.h"

enum { kBatch = 64 };

/* Reader of a topic that keeps the last word of each key for late joiners. */
static dds_entity_t reader_of(dds_entity_t participant, const dds_topic_descriptor_t* type,
                              const char* name) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
  const dds_entity_t topic = dds_create_topic(participant, type, name, NULL, NULL);
  const dds_entity_t reader = dds_create_reader(participant, topic, qos, NULL);
  dds_delete_qos(qos);
  if (reader < 0) {
    fprintf(stderr, "%s: %s\n", name, dds_strretcode(reader));
    exit(2);
  }
  return reader;
}

static void print_alarms(dds_entity_t reader) {
  void* samples[kBatch] = {NULL}; /* NULL: lend them */
  dds_sample_info_t infos[kBatch];
  const dds_return_t count = dds_take(reader, samples, infos, kBatch, kBatch);
  for (dds_return_t i = 0; i < count; ++i) {
    const mpm_Alarm* alarm = samples[i];
    /* Without data only the key is valid: the monitor has left, its last word does not stand. */
    printf("alarm %s %s %s %s\n", alarm->unit, alarm->mv, alarm->cv,
           infos[i].valid_data ? alarm->state : "unknown");
    if (infos[i].valid_data && alarm->cause_text[0] != '\0') printf("  %s\n", alarm->cause_text);
  }
  if (count > 0) dds_return_loan(reader, samples, count);
}

static void print_health(dds_entity_t reader) {
  void* samples[kBatch] = {NULL};
  dds_sample_info_t infos[kBatch];
  const dds_return_t count = dds_take(reader, samples, infos, kBatch, kBatch);
  for (dds_return_t i = 0; i < count; ++i) {
    const mpm_Health* health = samples[i];
    if (infos[i].valid_data)
      printf("health %s %s %s\n", health->unit, health->state, health->detail);
    else
      printf("health %s gone\n", health->unit);
  }
  if (count > 0) dds_return_loan(reader, samples, count);
}

int main(int argc, char** argv) {
  if (argc != 3) {
    fprintf(stderr, "usage: alarms DOMAIN SECONDS\n");
    return 3;
  }
  const dds_entity_t participant =
      dds_create_participant((dds_domainid_t)strtoul(argv[1], NULL, 10), NULL, NULL);
  if (participant < 0) {
    fprintf(stderr, "participant: %s\n", dds_strretcode(participant));
    return 2;
  }
  const dds_entity_t alarms = reader_of(participant, &mpm_Alarm_desc, "mpm/alarm");
  const dds_entity_t health = reader_of(participant, &mpm_Health_desc, "mpm/health");
  const dds_entity_t waitset = dds_create_waitset(participant);
  dds_waitset_attach(waitset, dds_create_readcondition(alarms, DDS_ANY_STATE), 0);
  dds_waitset_attach(waitset, dds_create_readcondition(health, DDS_ANY_STATE), 0);
  const dds_time_t end = dds_time() + DDS_SECS(atoi(argv[2]));
  while (dds_time() < end) {
    if (dds_waitset_wait(waitset, NULL, 0, DDS_MSECS(200)) <= 0) continue;
    print_alarms(alarms);
    print_health(health);
    fflush(stdout);
  }
  dds_delete(participant);
  return 0;
}
