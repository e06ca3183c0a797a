//! Tests of the room's own parts; the zoo (tests/zoo) tests the whole.
