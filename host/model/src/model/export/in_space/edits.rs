//! Changes of an XML text at byte ranges: what no change names stays byte for byte.

use roxmltree::Node;
use std::ops::Range;

/// Replacements within a text.
pub(super) struct Edits<'a> {
    text: &'a str,
    made: Vec<(Range<usize>, String)>,
}

impl<'a> Edits<'a> {
    /// None yet, of this text.
    pub fn of(text: &'a str) -> Self {
        Edits {
            text,
            made: Vec::new(),
        }
    }

    /// Puts a text in place of a range.
    pub fn replace(&mut self, range: Range<usize>, by: impl Into<String>) {
        self.made.push((range, by.into()));
    }

    /// Gives an element's attribute a value, and the attribute where it has none.
    pub fn set(&mut self, node: &Node, key: &str, value: &str) {
        match node.attribute_node(key) {
            Some(own) => {
                let range = value_of(self.text, own.range());
                self.replace(range, value);
            }
            None => {
                let at = self.attributes_end(node);
                self.replace(at..at, format!(" {key}=\"{value}\""));
            }
        }
    }

    /// As [`Edits::set`] of an attribute's first number; those behind it stay.
    pub fn set_first(&mut self, node: &Node, key: &str, value: &str) {
        let words = node.attribute(key).unwrap_or_default().split_whitespace();
        let words: Vec<&str> = std::iter::once(value).chain(words.skip(1)).collect();
        self.set(node, key, &words.join(" "));
    }

    /// Puts an element before all others within one, on a line of its own where those have one.
    pub fn insert(&mut self, node: &Node, child: &str) {
        let end = self.attributes_end(node);
        let tail = &self.text[end..];
        let close = end + tail.find('>').unwrap_or(0);
        if self.text[..close].ends_with('/') {
            let name = self.name(node);
            self.replace(close - 1..close + 1, format!(">{child}</{name}>"));
            return;
        }
        let behind = &self.text[close + 1..];
        let blanks = &behind[..behind.len() - behind.trim_start().len()];
        let indent = blanks.rfind('\n').map_or("", |line| {
            // A line that ends in two bytes does so here, too.
            let line = line - usize::from(blanks[..line].ends_with('\r'));
            &blanks[line..]
        });
        self.replace(close + 1..close + 1, format!("{indent}{child}"));
    }

    /// Puts an element behind all others within one.
    pub fn append(&mut self, node: &Node, child: &str) {
        let range = node.range();
        let end = self.text[range.clone()].rfind("</");
        let at = range.start + end.unwrap_or(0);
        self.replace(at..at, child);
    }

    /// The text with all changes.
    pub fn applied(mut self) -> String {
        self.made.sort_by_key(|(range, _)| (range.start, range.end));
        let (mut text, mut at) = (String::with_capacity(self.text.len()), 0);
        for (range, by) in &self.made {
            text.push_str(&self.text[at..range.start]);
            text.push_str(by);
            at = range.end;
        }
        text + &self.text[at..]
    }

    /// An element's name as the text has it, its prefix included.
    fn name(&self, node: &Node) -> &'a str {
        let behind = &self.text[node.range().start + 1..];
        let ends = |letter: char| letter.is_whitespace() || "/>".contains(letter);
        &behind[..behind.find(ends).unwrap_or(behind.len())]
    }

    /// Where an element's last attribute ends, or its name.
    fn attributes_end(&self, node: &Node) -> usize {
        let name = node.range().start + 1 + self.name(node).len();
        let ends = node.attributes().map(|own| own.range().end);
        ends.max().unwrap_or(name)
    }
}

/// The value within an attribute's range.
fn value_of(text: &str, attribute: Range<usize>) -> Range<usize> {
    let own = &text[attribute.clone()];
    let quote = own.find(['"', '\'']).unwrap_or(0);
    attribute.start + quote + 1..attribute.end - 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use roxmltree::Document;

    #[test]
    fn what_no_change_names_stays_byte_for_byte() {
        let text = "<!-- <a k=\"1\"/> -->\r\n<r a = '1'\tb=\"x &amp; y\" ><e/>\
                    <!-- kept --><f>\n  <g  k='3 4' />\n</f><h   /></r>\n";
        let document = Document::parse(text).unwrap();
        let find = |tag: &str| {
            let named = |node: &Node| node.has_tag_name(tag);
            document.descendants().find(named).unwrap()
        };
        let mut edits = Edits::of(text);
        edits.set(&find("r"), "a", "2");
        edits.set(&find("r"), "c", "5");
        edits.set(&find("e"), "k", "6");
        edits.set(&find("e"), "l", "7");
        edits.set_first(&find("g"), "k", "8");
        edits.insert(&find("f"), "<i/>");
        edits.insert(&find("h"), "<j/>");
        edits.append(&find("r"), "<z/>");
        let wanted = "<!-- <a k=\"1\"/> -->\r\n<r a = '2'\tb=\"x &amp; y\" c=\"5\" >\
                      <e k=\"6\" l=\"7\"/><!-- kept --><f>\n  <i/>\n  <g  k='8 4' />\n</f>\
                      <h   ><j/></h><z/></r>\n";
        assert_eq!(edits.applied(), wanted);
    }
}
