pub enum Kind{A}
