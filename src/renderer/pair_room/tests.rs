use super::*;

#[test]
fn room_grows_with_the_need_and_never_beyond_the_most() {
    let mut pairs = PairRoom::default();
    pairs.make(10, 20, 0);
    assert_eq!(pairs.room(), 200, "every splat in every tile");
    pairs.make(1000, 500, 0);
    assert_eq!(pairs.room(), 34_000, "the usual");
    pairs.make(1000, 500, 40_000);
    assert_eq!(pairs.room(), 50_000, "what was needed, and a quarter");
    pairs.make(1000, 500, 30_000);
    assert_eq!(pairs.room(), 50_000, "what there is stays");
    pairs.make(u32::MAX, u32::MAX, u32::MAX);
    assert_eq!(pairs.room(), MOST);
}

#[test]
fn what_would_not_fit_anyway_takes_no_memory() {
    let mut pairs = PairRoom::default();
    pairs.make(1000, 500, MOST);
    assert_eq!(pairs.room(), 34_000);
}

#[test]
fn what_is_expected_has_room_before_it_is_needed() {
    let mut pairs = PairRoom::default();
    pairs.make(1000, 500, 0);
    pairs.expect(100_000);
    assert_eq!(pairs.room(), 150_000, "and half as many more");
    pairs.expect(1_000);
    assert_eq!(pairs.room(), 150_000, "what there is stays");
    pairs.expect(MOST);
    assert_eq!(pairs.room(), 150_000, "what would not fit takes nothing");
}

#[test]
fn an_estimate_that_is_refused_takes_nothing_from_what_frames_need() {
    let mut pairs = PairRoom::default();
    pairs.make(1000, 500, 0);
    pairs.expect(1 << 20);
    pairs.refuse();
    pairs.make(1000, 500, 0);
    pairs.expect(1 << 20);
    assert_eq!(pairs.room(), 34_000, "the usual");
    pairs.make(1000, 500, 1 << 19);
    assert_eq!(pairs.room(), (1 << 19) + (1 << 17), "what was needed");
}

#[test]
fn what_a_host_has_reserved_neither_grows_nor_shrinks() {
    let mut pairs = PairRoom::fixed(5_000);
    pairs.make(1000, 500, 40_000);
    pairs.expect(100_000);
    assert_eq!(pairs.room(), 5_000);
    assert!(!pairs.can_grow_to(6_000));
}

#[test]
fn what_a_budget_has_no_room_for_waits_for_another_budget() {
    let mut pairs = PairRoom::default();
    pairs.make(1000, 500, 40_000);
    assert!(pairs.hold(Some(1 << 20)));
    assert_eq!(pairs.room(), 34_000, "the usual");
    pairs.review(Some(1 << 20));
    pairs.make(1000, 500, 40_000);
    pairs.expect(100_000);
    assert_eq!(pairs.room(), 34_000, "as long as it is the budget");
    assert!(!pairs.hold(Some(1 << 20)), "nothing has grown");
    pairs.review(Some(1 << 21));
    pairs.make(1000, 500, 40_000);
    assert_eq!(pairs.room(), 50_000);
}

#[test]
fn a_refusal_is_remembered() {
    let mut pairs = PairRoom::default();
    pairs.make(1000, 500, 40_000);
    pairs.refuse();
    pairs.make(1000, 500, 40_000);
    assert_eq!(pairs.room(), 25_000);
}

#[test]
fn a_frame_without_memory_is_tried_in_what_is_left() {
    let memory = || Error::Memory(String::new());
    let mut pairs = PairRoom::default();
    pairs.make(1000, 500, 40_000);
    let held = pairs.retry(Error::Budget(String::new()), Some(1), true);
    held.expect("it had grown");
    assert_eq!(pairs.room(), 34_000, "the usual");
    let mut tried = 0;
    let error = loop {
        pairs.make(1000, 500, 0);
        match pairs.retry(memory(), Some(1), true) {
            Ok(()) => tried += 1,
            Err(error) => break error,
        }
    };
    assert!(matches!(error, Error::Memory(_)));
    assert_eq!(tried, 4, "half the room each time");
    let without_lists = pairs.retry(memory(), None, false);
    assert!(without_lists.is_err(), "nothing is left");
}
