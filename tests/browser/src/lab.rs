//! A running lab, and plain requests to it: what a page of it sends, without a browser.

use serde_json::Value;
use std::ffi::OsStr;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Longer than any answer takes on a busy machine.
pub const PATIENCE: Duration = Duration::from_secs(60);

/// Longer than any work takes on a busy machine.
const WORKING: Duration = Duration::from_secs(240);

/// A lab that ends with the test.
#[derive(Debug)]
pub struct LabServer {
    child: Child,
    /// The address that it printed.
    pub address: String,
    /// Its port.
    pub port: u16,
    /// Cookies of a browser that came in.
    pub cookies: String,
}

impl Drop for LabServer {
    fn drop(&mut self) {
        self.kill();
    }
}

/// An answer.
#[derive(Debug)]
pub struct Response {
    /// Its status.
    pub status: u16,
    /// Its head, a line each.
    pub head: String,
    /// Its body, put together.
    pub body: Vec<u8>,
}

impl Response {
    /// The body as text.
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.body).into_owned()
    }

    /// The body as JSON.
    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.body).unwrap_or_else(|why| panic!("{why}: {}", self.text()))
    }

    fn cookies(&self) -> impl Iterator<Item = &str> {
        let lines = self.head.lines();
        let set = lines.filter_map(|line| line.strip_prefix("set-cookie: "));
        set.filter_map(|cookie| cookie.split(';').next())
    }

    /// The description before the numbers of a body of curves, and the arrays by name.
    pub fn curves(&self) -> (Value, Vec<(String, Vec<f32>)>) {
        assert_eq!(self.status, 200, "{}", self.text());
        let length = u32::from_le_bytes(self.body[..4].try_into().unwrap()) as usize;
        let head: Value = serde_json::from_slice(&self.body[4..4 + length]).unwrap();
        let mut at = 4 + length;
        let mut arrays = Vec::new();
        for array in head["arrays"].as_array().unwrap() {
            let end = at + 4 * array["length"].as_u64().unwrap() as usize;
            let number = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().unwrap());
            let values = self.body[at..end].chunks(4).map(number).collect();
            arrays.push((array["name"].as_str().unwrap().to_string(), values));
            at = end;
        }
        assert_eq!(at, self.body.len());
        (head["meta"].clone(), arrays)
    }
}

impl LabServer {
    /// `program lab` with these words in a folder, its sessions in `sessions` there; no client has
    /// come in yet.
    pub fn start_alone<S: AsRef<OsStr>>(
        program: &Path,
        folder: &Path,
        words: impl IntoIterator<Item = S>,
    ) -> LabServer {
        let mut child = Command::new(program)
            .arg("lab")
            .args(words)
            .arg("--session")
            .arg(folder.join("sessions"))
            .current_dir(folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap_or_else(|why| panic!("{}: {why}", program.display()));
        let mut address = String::new();
        let mut out = BufReader::new(child.stdout.take().unwrap());
        out.read_line(&mut address).unwrap();
        let address = address.trim().to_string();
        let port = address.split([':', '/']).find_map(|part| part.parse().ok());
        LabServer {
            child,
            port: port.unwrap_or_else(|| panic!("no address: {address:?}")),
            address,
            cookies: String::new(),
        }
    }

    /// The same; a browser has come in, and works in session 1.
    pub fn start<S: AsRef<OsStr>>(
        program: &Path,
        folder: &Path,
        words: impl IntoIterator<Item = S>,
    ) -> LabServer {
        let mut server = LabServer::start_alone(program, folder, words);
        server.come_in();
        server
    }

    /// Address of a page of its first session.
    pub fn page(&self, name: &str) -> String {
        format!("http://127.0.0.1:{}/s/1/{name}", self.port)
    }

    /// Number of its process.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Kills it as a crash would.
    pub fn kill(&mut self) {
        // It may be over before it is ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }

    /// Takes the token to the server, and a session from it; where the browser is sent.
    pub fn come_in(&mut self) -> String {
        let path = self.address.split_once("/enter").unwrap().1.to_string();
        let entered = self.ask("GET", &format!("/enter{path}"), &[], b"");
        assert_eq!(entered.status, 200, "{}", entered.text());
        let mut cookies: Vec<String> = entered.cookies().map(String::from).collect();
        self.cookies = cookies.join("; ");
        let home = self.get("/");
        assert_eq!(home.status, 303, "{}", home.text());
        cookies.extend(home.cookies().map(String::from));
        self.cookies = cookies.join("; ");
        let location = home
            .head
            .lines()
            .find_map(|line| line.strip_prefix("location: "));
        location.unwrap().to_string()
    }

    /// A page.
    pub fn get(&self, path: &str) -> Response {
        self.ask("GET", path, &[("Cookie", &self.cookies)], b"")
    }

    /// Data as a page of this server sends them.
    pub fn post(&self, path: &str, data: &Value) -> Response {
        self.post_bytes(path, "application/json", data.to_string().as_bytes())
    }

    /// Bytes, as a file that is dropped is sent.
    pub fn post_bytes(&self, path: &str, kind: &str, body: &[u8]) -> Response {
        let origin = format!("http://127.0.0.1:{}", self.port);
        let headers = [
            ("Cookie", self.cookies.as_str()),
            ("Origin", &origin),
            ("Content-Type", kind),
        ];
        self.ask("POST", path, &headers, body)
    }

    /// A request with these headers; `Host` and `Content-Length` are those of a browser unless
    /// they are among them.
    pub fn ask(&self, method: &str, path: &str, headers: &[(&str, &str)], body: &[u8]) -> Response {
        let given = |name| headers.iter().any(|(key, _)| *key == name);
        let mut head = format!("{method} {path} HTTP/1.1\r\nConnection: close\r\n");
        if !given("Host") {
            head += &format!("Host: 127.0.0.1:{}\r\n", self.port);
        }
        if !given("Content-Length") && !given("Transfer-Encoding") {
            head += &format!("Content-Length: {}\r\n", body.len());
        }
        for (key, value) in headers {
            head += &format!("{key}: {value}\r\n");
        }
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        stream.write_all(format!("{head}\r\n").as_bytes()).unwrap();
        // A server that has refused the request may close before it took the body.
        let _ = stream.write_all(body);
        let mut bytes = Vec::new();
        let _ = stream.read_to_end(&mut bytes);
        let end = bytes.windows(4).position(|four| four == b"\r\n\r\n");
        let end = end.unwrap_or_else(|| panic!("no answer to {method} {path}"));
        let head = String::from_utf8_lossy(&bytes[..end]).replace("\r\n", "\n");
        let status = head
            .split(' ')
            .nth(1)
            .and_then(|status| status.parse().ok());
        let body = bytes.split_off(end + 4);
        Response {
            status: status.unwrap(),
            body: if head.to_lowercase().contains("transfer-encoding: chunked") {
                joined(&body)
            } else {
                body
            },
            head,
        }
    }

    /// Waits for the end of what session 1 does, and gives its last state.
    pub fn wait(&self) -> Value {
        let end = self.ends_within(WORKING);
        end.unwrap_or_else(|state| panic!("it has not ended in {WORKING:?}: {state}"))
    }

    /// The last state of what session 1 does, or, as an error, the one after so long.
    pub fn ends_within(&self, patience: Duration) -> Result<Value, Value> {
        let begun = Instant::now();
        loop {
            let state = self.state();
            if state["state"] != "running" {
                return Ok(state);
            }
            if begun.elapsed() > patience {
                return Err(state);
            }
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// The first event of session 1's progress.
    pub fn state(&self) -> Value {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let head = format!(
            "GET /s/1/progress HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nCookie: {}\r\n\r\n",
            self.port, self.cookies
        );
        stream.write_all(head.as_bytes()).unwrap();
        for line in BufReader::new(stream).lines() {
            if let Some(data) = line.unwrap().strip_prefix("data: ") {
                return serde_json::from_str(data).unwrap();
            }
        }
        panic!("no event came");
    }
}

/// A body that came in chunks.
fn joined(mut body: &[u8]) -> Vec<u8> {
    let mut whole = Vec::new();
    while let Some(end) = body.windows(2).position(|two| two == b"\r\n") {
        let size = std::str::from_utf8(&body[..end]).unwrap();
        let size = usize::from_str_radix(size, 16).unwrap();
        whole.extend(&body[end + 2..end + 2 + size]);
        body = &body[end + 4 + size..];
        if size == 0 {
            break;
        }
    }
    whole
}
