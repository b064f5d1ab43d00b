//! The tags of an XML text, one after the other: what reading 3MF needs and no more.
//!
//! Text between tags, comments and instructions are passed over without being kept, so a file
//! cannot fill the memory with them. A document type, by which XML texts grow without end, is
//! refused, as the format demands.

use std::io::{self, BufRead, Read};

/// A longer tag belongs to no model.
const LONGEST_TAG: u64 = 1 << 16;

/// Why a text cannot be read on.
#[derive(Debug)]
pub(super) enum XmlFault {
    /// What it is read from failed.
    Io(io::Error),
    /// It is no XML that is read here.
    Text(&'static str),
}

impl From<io::Error> for XmlFault {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// Tags in the order of the text.
pub(super) struct Tags<R> {
    text: R,
    tag: Vec<u8>,
}

/// `<prefix:name attributes>`, `<prefix:name attributes/>` or `</prefix:name>`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tag<'a> {
    /// What stands before the colon; empty without one.
    pub(super) prefix: &'a str,
    pub(super) name: &'a str,
    pub(super) kind: TagKind,
    attributes: &'a str,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TagKind {
    /// Something follows, up to the closing tag.
    Open,
    /// Nothing is in it.
    Empty,
    Close,
}

impl<R: BufRead> Tags<R> {
    pub(super) fn new(text: R) -> Self {
        let tag = Vec::new();
        Self { text, tag }
    }

    /// The next tag; `None` at the end of the text.
    pub(super) fn next(&mut self) -> Result<Option<Tag<'_>>, XmlFault> {
        loop {
            if !self.skip_to_tag()? {
                return Ok(None);
            }
            self.tag.clear();
            self.read_to_bracket()?;
            if self.tag.starts_with(b"!--") {
                self.skip_to(b"-->", 6)?;
            } else if self.tag.starts_with(b"![CDATA[") {
                self.skip_to(b"]]>", 11)?;
            } else if self.tag.starts_with(b"!") {
                return Err(XmlFault::Text("it has a document type, which 3MF forbids"));
            } else if self.tag.starts_with(b"?") {
                self.skip_to(b"?>", 3)?;
            } else {
                break;
            }
        }
        let mut looked_at = 0;
        let mut quote = None;
        loop {
            quote = quote_after(quote, &self.tag[looked_at..]);
            if quote.is_none() {
                break;
            }
            looked_at = self.tag.len();
            self.read_to_bracket()?;
        }
        let body = &self.tag[..self.tag.len() - 1];
        let body = std::str::from_utf8(body)
            .map_err(|_| XmlFault::Text("it has a tag that is no UTF-8 text"))?;
        Ok(Some(Tag::of(body)))
    }

    /// Passes over everything up to the next `<`, it included; says whether there is one.
    fn skip_to_tag(&mut self) -> io::Result<bool> {
        loop {
            let buffer = self.text.fill_buf()?;
            let (length, place) = (buffer.len(), buffer.iter().position(|byte| *byte == b'<'));
            self.text.consume(place.map_or(length, |place| place + 1));
            if place.is_some() || length == 0 {
                return Ok(place.is_some());
            }
        }
    }

    /// Adds everything up to the next `>` to the tag.
    fn read_to_bracket(&mut self) -> Result<(), XmlFault> {
        let room = LONGEST_TAG.saturating_sub(self.tag.len() as u64);
        let mut rest = self.text.by_ref().take(room);
        let length = rest.read_until(b'>', &mut self.tag)?;
        if length > 0 && self.tag.last() == Some(&b'>') {
            return Ok(());
        }
        Err(XmlFault::Text(if self.tag.len() as u64 >= LONGEST_TAG {
            "it has a tag that does not end"
        } else {
            "it ends inside a tag"
        }))
    }

    /// Passes over what is not to be read, of which at least `least` bytes are there, up to `end`.
    fn skip_to(&mut self, end: &[u8], least: usize) -> Result<(), XmlFault> {
        let mut length = self.tag.len();
        while length < least || !self.tag.ends_with(end) {
            let kept = self.tag.len().saturating_sub(end.len());
            self.tag.drain(..kept);
            let before = self.tag.len();
            // In pieces, so that a long comment stays out of memory.
            self.text
                .by_ref()
                .take(LONGEST_TAG)
                .read_until(b'>', &mut self.tag)?;
            if self.tag.len() == before {
                return Err(XmlFault::Text("it ends inside a comment"));
            }
            length += self.tag.len() - before;
        }
        Ok(())
    }
}

/// The quotation mark that is open after `text` if `open` was before it; in quotes, `>` is a letter
/// like any other.
fn quote_after(open: Option<u8>, text: &[u8]) -> Option<u8> {
    let marks = text.iter().filter(|byte| matches!(byte, b'"' | b'\''));
    marks.fold(open, |open, &mark| match open {
        None => Some(mark),
        Some(quote) if quote == mark => None,
        Some(quote) => Some(quote),
    })
}

impl<'a> Tag<'a> {
    fn of(body: &'a str) -> Self {
        let (body, kind) = match (body.strip_prefix('/'), body.strip_suffix('/')) {
            (Some(rest), _) => (rest, TagKind::Close),
            (None, Some(rest)) => (rest, TagKind::Empty),
            (None, None) => (body, TagKind::Open),
        };
        let end = body
            .find(|c: char| c.is_ascii_whitespace())
            .unwrap_or(body.len());
        let (name, attributes) = body.split_at(end);
        let (prefix, name) = name.split_once(':').unwrap_or(("", name));
        Self {
            prefix,
            name,
            kind,
            attributes,
        }
    }

    /// Names, without their prefixes, and values; ends where what follows is none.
    pub(super) fn attributes(&self) -> impl Iterator<Item = (&'a str, &'a str)> {
        let mut rest = self.attributes;
        std::iter::from_fn(move || {
            let (name, after) = rest.split_once('=')?;
            let after = after.trim_ascii_start();
            let quote = after.chars().next().filter(|c| matches!(c, '"' | '\''))?;
            let (value, after) = after[1..].split_once(quote)?;
            rest = after;
            let name = name.trim_ascii();
            Some((name.split_once(':').map_or(name, |(_, name)| name), value))
        })
    }

    /// The value of the attribute `name`.
    pub(super) fn attribute(&self, name: &str) -> Option<&'a str> {
        self.attributes()
            .find_map(|(is, value)| (is == name).then_some(value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(text: &str) -> Result<Vec<String>, XmlFault> {
        let mut tags = Tags::new(text.as_bytes());
        let mut names = Vec::new();
        while let Some(tag) = tags.next()? {
            let attributes: Vec<String> =
                tag.attributes().map(|(n, v)| format!("{n}={v}")).collect();
            names.push(format!(
                "{:?} {} {}",
                tag.kind,
                tag.name,
                attributes.join(",")
            ));
        }
        Ok(names)
    }

    #[test]
    fn tags_are_found_among_all_else_that_xml_has() {
        let text = "\u{feff}<?xml version='1.0'?> <!-- <no> --><a x = '1' p:y=\"2 > 1\">text\
                    <![CDATA[ <no/> ]]><!--><b>--><p:b/></a >";
        assert_eq!(
            names(text).unwrap(),
            ["Open a x=1,y=2 > 1", "Empty b ", "Close a "]
        );
    }

    #[test]
    fn what_does_not_end_or_has_a_document_type_is_refused() {
        for text in [
            "<a",
            "<a x='>",
            "<!-- >",
            "<!DOCTYPE x>",
            "<![CDATA[ ]>",
            "<?xml",
            "<",
        ] {
            assert!(matches!(names(text), Err(XmlFault::Text(_))), "{text}");
        }
        let long = format!("<a {}>", "x".repeat(1 << 17));
        assert!(matches!(names(&long), Err(XmlFault::Text(_))));
        let comment = format!("<!-- {} --><a/>", ">-".repeat(1 << 17));
        assert_eq!(names(&comment).unwrap(), ["Empty a "]);
    }
}
