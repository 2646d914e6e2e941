//! empty
#[test] fn f() {}
