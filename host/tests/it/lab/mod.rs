//! The lab: over HTTP as a program sees it, and in a browser as a person does.

mod browser;
mod http;
mod pages;
mod safety;
mod server;
mod speed;
