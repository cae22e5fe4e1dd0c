#![doc = "What host and firmware agree on."]
#![no_std]
#![forbid(unsafe_code)]
